import { fixed } from '../lib/format';
import { Sign } from '../parts/controls';
import { events } from '../state/event_log';

/** The events of the run, newest first. */
export function EventsView() {
  return (
    <section class="stack" aria-label="Events">
      <h2>Events</h2>
      {events.value.length === 0 ? (
        <p class="soft">No events so far.</p>
      ) : (
        <ol class="events" tabIndex={0}>
          {events.value.map(({ id, severity, text, time, duration }) => (
            <li class="row line" key={id}>
              <span class="event-time keep">{fixed(time, 2)} s</span>
              <Sign of={severity} />
              <span>{text}</span>
              {duration !== null && (
                <span class="unit keep">
                  for {duration < 1 ? `${fixed(duration * 1000, 0)} ms` : `${fixed(duration, 1)} s`}
                </span>
              )}
            </li>
          ))}
        </ol>
      )}
    </section>
  );
}
