#!/usr/bin/env python3
"""`chicane ros` and `chicane ros --simulate` as two processes on loopback, in a DDS domain of their own.

    two_processes.py CHICANE --kill PARTNER      a lap like that of `drive`; kill -9 of the controller, then of the
                                                 simulator
    two_processes.py CHICANE --laps PARTNER      three laps on two tracks, with both meanings of a drive message
    two_processes.py CHICANE --pace              both in simulated time, by /clock at half the pace
    two_processes.py CHICANE --own PROGRAM       a program of examples/ros drives the simulated car
    two_processes.py CHICANE --vendors RELAY     another vendor's DDS between the two (fast_relay.cpp): laps, and a bad network
    two_processes.py CHICANE --misfit PARTNER    partners that do it wrong (partner.cpp): each is said in words
"""
import atexit
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

DOMAIN = 101 + os.getpid() % 100
CLOSE_S = 0.1  # lap times of two processes and of one differ by less on a machine that has time for them
CLOSE_BESIDE_OTHERS_S = 0.5  # beside other tests


class Program:
    """A running `chicane ros`, and what it says."""

    def __init__(self, chicane, folder, name, *words, domain=DOMAIN):
        self.name = name
        self.out = Path(folder, name + ".out")
        self.err = Path(folder, name + ".err")
        with self.out.open("wb") as out, self.err.open("wb") as err:
            self.process = subprocess.Popen([chicane, "ros", "--domain", str(domain), "--json", *words], stdout=out, stderr=err)
        atexit.register(self.process.kill)

    def said(self):
        return self.err.read_text(errors="replace").replace("\r", "\n")

    def wait_for(self, pattern, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = re.search(pattern, self.said())
            if found:
                return found
            if self.process.poll() is not None and not re.search(pattern, self.said()):
                break
            time.sleep(0.05)
        sys.exit(f"{self.name} did not say /{pattern}/ within {seconds} s:\n{self.said()}")

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def finish(self, seconds):
        code = self.process.wait(timeout=seconds)
        return code, json.loads(self.out.read_text())

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)
        return self.finish(10)


def check(condition, sentence):
    if not condition:
        sys.exit(f"not so: {sentence}")
    print(f"ok: {sentence}", flush=True)


def laps_alone(chicane, *words):
    done = subprocess.run([chicane, "drive", "--fast", "--json", "--car", "f1tenth", *words], capture_output=True, check=True)
    return [lap["lap_time_s"] for lap in json.loads(done.stdout)["laps"]]


def a_lap_and_two_kills(chicane, folder):
    alone = laps_alone(chicane, "--track", "oval", "--laps", "1")
    simulator = Program(chicane, folder, "simulator", "--simulate", "--track", "oval", "--laps", "0")
    controller = Program(chicane, folder, "controller", "--track", "oval", "--port", "0")
    simulator.wait_for(r"first command", 10)
    lap = float(simulator.wait_for(r"lap 1: ([\d.]+) s, .*clean", 30)[1])
    check(abs(lap - alone[0]) <= CLOSE_BESIDE_OTHERS_S, f"the lap took {lap} s, and {alone[0]:.2f} s in one process")
    controller.wait_for(r"lap 1: ", 2)

    controller.kill()
    simulator.wait_for(r"no command in time: the car is stopped from", 3)
    stands = simulator.wait_for(r"the car stands, its outermost wheel ([\d.]+) m (\w+) the road's edge", 8)
    check(stands[2] == "inside", f"kill -9 of the controller: the car stands {stands[1]} m inside the edge")

    other = Program(chicane, folder, "other_controller", "--track", "oval", "--port", "0")
    simulator.wait_for(r"another sender on /drive", 10)
    simulator.wait_for(r"commands again", 5)
    check(True, "another controller takes over")
    time.sleep(1.0)
    tell = [sys.argv[3], str(DOMAIN), "1"]
    subprocess.run([*tell, "stop"], check=True)
    other.wait_for(r"stopped by request", 3)
    for _ in range(20):  # it refuses until the car stands
        subprocess.run([*tell, "go"], check=True)
        if "drives on by request" in other.said():
            break
    check("drives on by request" in other.said(), "stopped by request, and driven on from rest")
    time.sleep(1.0)
    simulator.kill()
    other.wait_for(r"no odometry on /ego_racecar/odom for", 5)
    code, run = other.interrupt()
    check(code == 0 and run["off_track_events"] == 0, "kill -9 of the simulator: the controller says so, and ends as it should")


def laps(chicane, folder):
    lap_by_path(chicane, folder)
    for track in ("oval", "lakeside"):
        for drive_by in ("speed", "acceleration"):
            words = ["--track", track, "--laps", "3"]
            alone = laps_alone(chicane, *words)
            name = f"{track}_{drive_by}"
            simulator = Program(chicane, folder, f"simulator_{name}", "--simulate", "--drive-by", drive_by, *words)
            controller = Program(chicane, folder, f"controller_{name}", "--track", track, "--drive-by", drive_by, "--port", "0")
            code, run = simulator.finish(400)
            controller.interrupt()
            both = [lap["lap_time_s"] for lap in run["laps"]]
            worst = max(abs(a - b) for a, b in zip(alone, both, strict=True))
            check(code == 0 and worst <= CLOSE_S,
                  f"{track} by {drive_by}: {', '.join(f'{t:.2f}' for t in both)} s, at most {worst:.3f} s from one process")


def lap_by_path(chicane, folder):
    simulator = Program(chicane, folder, "path_simulator", "--simulate", "--track", "oval", "--laps", "1")
    # The road's line of a controller that knows the track is the path of one that does not.
    knows = Program(chicane, folder, "knows", "--track", "oval", "--port", "0", "--drive-topic", "/unused")
    follows = Program(chicane, folder, "follows", "--path-topic", "/track/centre", "--port", "0")
    code, run = simulator.finish(120)
    check(code == 0, f"a lap by a nav_msgs/Path: {run['laps'][0]['lap_time_s']:.2f} s, {run['off_track_events']} times off the road")
    follows.interrupt()
    knows.interrupt()


class Relay:
    """fast_relay between a simulator's domain and a controller's."""

    def __init__(self, folder, name, domain, *words):
        self.out = Path(folder, name + ".relay")
        with self.out.open("wb") as out:
            self.process = subprocess.Popen([sys.argv[3], str(domain), str(domain + 1), "600", *words], stdout=out)
        atexit.register(self.process.kill)

    def finish(self):
        self.process.terminate()
        self.process.wait(timeout=20)
        return json.loads(self.out.read_text())


def both_ends(chicane, folder, name, domain, track, laps, *words, domain_of_controller=0):
    """Simulator and controller, each in a domain of its own."""
    simulator = Program(chicane, folder, f"simulator_{name}", "--simulate", "--track", track, "--laps", str(laps), domain=domain)
    controller = Program(chicane, folder, f"controller_{name}", "--track", track, "--port", "0", *words, domain=domain_of_controller or domain + 1)
    return simulator, controller


def vendors(chicane, folder):
    """The other vendor receives, decodes, encodes anew and sends every message."""
    domain = 2 * (DOMAIN // 2)
    simulator, controller = both_ends(chicane, folder, "node", domain, "oval", 0, domain_of_controller=domain)
    simulator.wait_for(r"first command", 20)
    for release in ([], ["iron"]):
        said = subprocess.run([sys.argv[3], "node", str(domain), *release], capture_output=True, text=True, timeout=60)
        check(said.returncode == 0, f"a node of rmw_fastrtps asks: {said.stdout.strip()} {said.stderr.strip()}")
        seen = json.loads(said.stdout)
        check(seen["listed"] > 50 and seen["type"] == 3 and seen["set"] and not seen["set_atomically"] and seen["value"] == 2.0 and
              seen["described_bytes"] > 5000, "its parameter services answer")
        check(seen["nodes"] == ["/chicane", "/chicane_simulator"], "it sees both nodes")
        check(seen["maps"] == 1 and seen["scans"] > 0, "it sees /map and /scan")
    simulator.kill()
    controller.interrupt()
    for track in ("oval", "lakeside"):
        alone = laps_alone(chicane, "--track", track, "--laps", "3")
        relay = Relay(folder, track, domain)
        simulator, controller = both_ends(chicane, folder, f"vendors_{track}", domain, track, 3)
        code, run = simulator.finish(400)
        controller.interrupt()
        passed = relay.finish()
        both = [lap["lap_time_s"] for lap in run["laps"]]
        worst = max(abs(a - b) for a, b in zip(alone, both, strict=True))
        check(code == 0 and worst <= CLOSE_S, f"{track} through Fast DDS: {', '.join(f'{t:.2f}' for t in both)} s, at most "
              f"{worst:.3f} s from one process")
        check(passed["different"] == 0, f"its bytes are ours, {passed['commands']} commands; from odometry to command "
              f"{passed['p50_ms']:.2f} ms p50, {passed['p999_ms']:.2f} ms p99.9")
    bad = [  # what the network does, and what the controller says of it
        (["loss=0.1"], ""),
        (["twice=0.2"], r"a message of /ego_racecar/odom came twice: such messages are left out"),
        (["swap=0.1"], r"a message of /ego_racecar/odom came after a newer one: such messages are left out"),
        (["loss=0.1", "twice=0.1", "swap=0.1"], r"such messages are left out"),
        (["jump_s=5", "jump_at_s=6"], r"the clock of /ego_racecar/odom jumped by \+5.0 s"),
        (["jump_s=-5", "jump_at_s=6"], r"the clock of /ego_racecar/odom jumped by -5.0 s"),
    ]
    for words, pattern in bad:
        name = "_".join(words).replace("=", "")
        relay = Relay(folder, name, domain, *words)
        simulator, controller = both_ends(chicane, folder, name, domain, "oval", 1)
        code, run = simulator.finish(120)
        said = controller.wait_for(pattern, 1)[0] if pattern else "nothing to say"
        controller.interrupt()
        relay.finish()
        check(code == 0, f"{' '.join(words)}: a lap of {run['laps'][0]['lap_time_s']:.2f} s, on the road; {said}")
    relay = Relay(folder, "kill", domain)
    simulator, controller = both_ends(chicane, folder, "kill", domain, "oval", 0)
    controller.wait_for(r"odometry of", 20)
    time.sleep(6.0)
    controller.kill()
    simulator.wait_for(r"no command in time: the car is stopped from", 5)
    stands = simulator.wait_for(r"the car stands, its outermost wheel ([\d.]+) m (\w+) the road's edge", 10)
    check(stands[2] == "inside", f"kill -9 of the controller: the car stands {stands[1]} m inside the edge")
    other = Program(chicane, folder, "after", "--track", "oval", "--port", "0", domain=domain + 1)
    simulator.wait_for(r"commands again", 30)
    time.sleep(2.0)
    relay.process.kill()  # the other vendor's program
    other.wait_for(r"no odometry on /ego_racecar/odom for", 10)
    stands = simulator.wait_for(r"(?s)commands again.*the car stands, its outermost wheel ([\d.]+) m (\w+) the road's edge", 15)
    check(stands[2] == "inside", f"kill -9 of the program between: the car stands {stands[1]} m inside the edge, and both ends say why")
    simulator.kill()
    other.interrupt()
    relay = Relay(folder, "qos", domain, "best-effort")
    simulator, controller = both_ends(chicane, folder, "qos", domain, "oval", 1, "--odom-qos", "reliable")
    said = controller.wait_for(r"is sent best effort by a partner, .*use --odom-qos best-effort", 20)[0]
    check(True, f"best effort to a reliable reader: {said}")
    simulator.kill()
    controller.interrupt()
    relay.finish()


def laps_in_simulated_time(chicane, folder):
    alone = laps_alone(chicane, "--track", "oval", "--laps", "1")
    simulator = Program(chicane, folder, "slow_simulator", "--simulate", "--track", "oval", "--laps", "1", "--pace", "0.5")
    controller = Program(chicane, folder, "slow_controller", "--track", "oval", "--port", "0", "--use-sim-time")
    code, run = simulator.finish(60)
    controller.wait_for("/clock is there: time is simulated", 1)
    controller.interrupt()
    lap = run["laps"][0]["lap_time_s"]
    check(code == 0 and abs(lap - alone[0]) <= CLOSE_BESIDE_OTHERS_S and run["wall_time_s"] > 1.8 * lap,
          f"by /clock at half the pace: {lap:.2f} s in {run['wall_time_s']:.1f} s, and {alone[0]:.2f} s in one process")


def own_program(chicane, folder):
    simulator = Program(chicane, folder, "own_simulator", "--simulate", "--track", "oval", "--laps", "1")
    program = subprocess.Popen([sys.argv[3], str(DOMAIN)], stdout=subprocess.DEVNULL)
    atexit.register(program.kill)
    code, run = simulator.finish(90)
    program.kill()
    check(code == 0, f"a program of one's own drives a lap in {run['laps'][0]['lap_time_s']:.2f} s, on the road")


def misfits(chicane, folder):
    partner = sys.argv[3]
    cases = [  # a fault of the partner, options of the controller, what is said
        ("best-effort", ["--odom-qos", "reliable"], r"is sent best effort by a partner, .*use --odom-qos best-effort"),
        ("reliable-reader", ["--drive-qos", "best-effort"], r"/drive is read reliably by a partner, .*use --drive-qos reliable"),
        ("wrong-type", [], r"got a partner with type geometry_msgs/msg/PoseWithCovarianceStamped, expected nav_msgs/msg/Odometry"),
        ("best-effort", ["--odom-topic", "/odom"],
         r"nobody sends /odom; nav_msgs/msg/Odometry is on /ego_racecar/odom: --odom-topic names another topic"),
        ("clock", [], r"the clock of /ego_racecar/odom jumped by \+5.0 s"),
        ("twice", [], r"a message of /ego_racecar/odom came (twice|after a newer one): such messages are left out"),
        ("garbage", [], r"got bytes that are no nav_msgs/msg/Odometry"),
        ("no-numbers", [], r"(?s)got numbers that are not finite.*It ends .*\. Send the pose on /initialpose, or drive there by hand"),
        ("odom-frame", [], r"got the frame \"odom\", expected \"map\": brought there by /tf"),
        ("", [], r"no other program in domain \d+"),
    ]
    running = []
    for i, (fault, words, _) in enumerate(cases):
        domain = 200 + (DOMAIN + i) % 30
        other = subprocess.Popen([partner, str(domain), "12", fault]) if fault else None
        if other:
            atexit.register(other.kill)
        running.append((Program(chicane, folder, f"controller_{i}", "--track", "oval", "--port", "0", *words, domain=domain), other))
    for (program, other), (fault, _, pattern) in zip(running, cases, strict=True):
        said = program.wait_for(pattern, 15)[0]
        program.interrupt()
        check(True, f"{fault or 'nobody'}: {said.splitlines()[-1]}")
        if other:
            other.kill()
            other.wait()


def main():
    chicane, mode = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        {"--kill": a_lap_and_two_kills, "--laps": laps, "--misfit": misfits, "--own": own_program, "--pace": laps_in_simulated_time, "--vendors": vendors}[mode](chicane, folder)


main()
