import { render } from 'preact';
import { Connection, SUBPROTOCOLS, type ServiceName } from './protocol/connection';
import { attempt, isPaused, link, notice, receive, refreshText, services } from './state/app_state';
import { everyFrame } from './state/ticker';
import { CockpitView } from './views/cockpit_view';
import { ControllerView } from './views/controller_view';
import { HeaderView, type Actions } from './views/header_view';
import { PlotsView } from './views/plots_view';
import { nextView, TrackView, zoom } from './views/track_view';

const url = new URL('viewer', location.href);
url.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';

const connection = new Connection(() => new WebSocket(url, SUBPROTOCOLS), {
  open() {
    link.value = 'live';
    attempt.value = 0;
  },
  lost(number) {
    link.value = 'lost';
    attempt.value = number;
  },
  message: (topic, message) => receive(topic, message, performance.now()),
  services: (names) => (services.value = names),
  notice: (sentence) => (notice.value = sentence),
});

const actions: Actions = {
  call(name: ServiceName, data?: boolean) {
    void connection.call(name, data).then((sentence) => {
      if (sentence !== null) notice.value = sentence;
    });
  },
  retry: () => connection.retryNow(),
};

const KEYS: Readonly<Record<string, () => void>> = {
  ' ': () => actions.call('/pause', !isPaused.value),
  s: () => actions.call('/step'),
  r: () => actions.call('/reset'),
  c: nextView,
  '+': () => zoom(0.8),
  '=': () => zoom(0.8),
  '-': () => zoom(1.25),
};

addEventListener('keydown', (event) => {
  const action = KEYS[event.key.toLowerCase()];
  const isOnButton = event.target instanceof HTMLButtonElement && event.key === ' ';
  if (!action || isOnButton || event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
  event.preventDefault();
  action();
});

function App() {
  return (
    <>
      <HeaderView actions={actions} />
      <main class={link.value === 'lost' ? 'stage stale' : 'stage'}>
        <TrackView />
        <aside class="side" aria-label="Car and controller">
          <CockpitView />
          <ControllerView />
        </aside>
        <PlotsView />
      </main>
    </>
  );
}

everyFrame((now) => refreshText(now), 100);
const root = document.getElementById('app');
if (root) render(<App />, root);
