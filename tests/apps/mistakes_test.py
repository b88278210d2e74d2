# SPDX-License-Identifier: MIT
"""Typical mistakes and what the program says to them: `mistakes_test.py PROGRAM`. Each message names the place, what was got, what is
expected and, where that is not the expectation itself, what to do. `{name}`: a file of that content."""
import shlex
import unittest

from program import InFolder, run

USAGE = "--help`"

FILES = {
    "three.csv": "x_m,y_m\n0,0\n50,0\n25,40\n",
    "commas.csv": "x_m;y_m\n1,000.5;0\n50;0\n50;50\n",
    "key.yaml": "preset: default\ntracking_mpc:\n  horizon_stepz: 12\n",
    "track.yaml": "track: lakesite\n",
    "text.mcap": "not a recording\n",
}

# command | place | got | expected | remedy
MISTAKES = [line.split(" | ") for line in f"""\
drvie --fast | chicane | got the unknown command drvie | expected one of drive | (did you mean drive?)
drive --pressets race | chicane drive | got --pressets | expected one of its options | (did you mean --preset?)
drive --fast --latency 100 | chicane drive | got --latency | expected one of its options | (did you mean --latency-ms?)
drive --fast --speed-mph 300 | --speed-mph | got 300 | expected a number in [2.237, 246.1] mph |
drive --fast --speed-mps 0 | --speed-mps | got 0 | expected a number in [1, 110] m/s |
drive --fast guard=off | scenario | got "guard=off" | expected a file or one of | (did you mean --set guard.mode=off?)
drive --fast --set guard=off | guard | got an unknown key | expected one of `chicane list parameters` | (did you mean guard.mode?)
drive --fast --speed-mph 60mph | --speed-mph | got 60mph | expected a number | {USAGE}
drive --fast --speed-mph | --speed-mph | got nothing | expected a number | {USAGE}
drive --fast --speed-mph 60 --speed-mps 20 | --speed-mps | got it with --speed-mph | expected one of the two | {USAGE}
drive --fast --laps 2 --laps 3 | --laps | got it 2 times (2, 3) | expected once | {USAGE}
drive --fast --laps 2.5 | --laps | got 2.5 | expected an integer in [0, 10000] |
drive --fast --seed 0.5 | --seed | got 0.5 | expected an integer in |
drive --fast --preset sixty_mph | preset | got "sixty_mph" | expected a file or one of default | (did you mean sixty-mph?)
drive --fast --preset= | --preset | got nothing | expected NAME | chicane list presets
drive --fast --track Lakeside | track | got "Lakeside" | expected a file or one of crossover | (did you mean lakeside?)
drive --fast --track lakeside.cvs | track | got lakeside.cvs | expected a file that exists | (did you mean lakeside?)
drive --fast --track /etc | track | got /etc | expected a file that exists |
drive --fast lakeside | scenario | got "lakeside" | expected a file or one of | (did you mean --track lakeside?)
drive --fast one two | chicane drive | got two | expected nothing more | {USAGE}
drive --fast --car road_car | car | got "road_car" | expected a file or one of bmw-320i | (did you mean road-car?)
drive --fast --controller MPC | controller | got MPC | expected one of tracking-mpc, cubic-mpc |
drive --fast --latency-ms 100ms | --latency-ms | got 100ms | expected a number in [0, 500] ms |
drive --fast --set horizon_steps=20 | horizon_steps | got an unknown key | expected one of `chicane list parameters` | (did you mean tracking_mpc.horizon_steps?)
drive --fast --set tracking_mpc.horizon_steps = 20 | --set | got tracking_mpc.horizon_steps | expected key=value | without blanks
drive --fast --set tracking_mpc.horizon_steps=20.5 | tracking_mpc.horizon_steps | got 20.5 | expected an integer in [5, 100] |
drive --fast --set guard.mode=disabled | guard.mode | got disabled | expected one of on, observe, off |
drive --fast --set waypoints_sent=1 | waypoints_sent | got 1 | expected an integer in [2, 32] |
drive --fast --fault half_gripp@5 | --fault half_gripp@5 | got half_gripp | expected one of `chicane list faults` | NAME@SECOND+SECONDS*STRENGTH
drive --fast --fault half_grip@-5 | --fault half_grip@-5 | got -5 | expected a number in [0, 1000000] |
drive --fast --report page.txt | --report | got page.txt | expected a name that ends in .html |
drive --fast --record a.html --report a.html | --report | got a.html | expected another file than --record |
drive --fast --compress | --compress | got it alone | expected --record with it | {USAGE}
drive --fast --pace 2 | --pace | got it with --fast | expected one of the two | {USAGE}
drive --pace 100 | --pace | got 100 | expected a number in [0.05, 20] | {USAGE}
drive --port http | --port | got http | expected a whole number in [0, 65535] | {USAGE}
serve --address localhost | address | got 'localhost' | expected a numeric address |
serve --address 0.0.0.0 --no-token | address | got 0.0.0.0 without a token | expected one of this machine or a token |
simulate --connect localhost:4567 | url | got 'localhost:4567' | expected ws://host:port/path |
simulate --connect ws://car:0 | url | got 'ws://car:0' | expected a port in [1, 65535] |
replay | logs | got nothing | expected LOG | {USAGE}
replay {{text.mcap}} | text.mcap: file | got other content | expected an MCAP file |
report {{text.mcap}} | report | got none of --output, --page and --compare | expected one |
report {{text.mcap}} -o page.pdf | --output | got page.pdf | expected a name that ends in .html |
import road.csv --preview road.png | --preview | got road.png | expected a name that ends in .html |
limit --budget-s 0 | --budget-s | got 0 | expected a number > 0 | {USAGE}
drive --fast=yes | --fast | got yes | expected no value | {USAGE}
limit --car | --car | got nothing | expected NAME|FILE (chicane list cars) | {USAGE}
limit --car f1tenth | limit | got the model car f1tenth | expected one in full size |
drive --limit | --limit | got it alone | expected --fast with it |
list track | what | got track | expected one of presets, tracks | {USAGE}
completion ksh | shell | got ksh | expected one of bash, zsh, fish | {USAGE}
check | check | got nothing | expected files or settings |
check missing.csv | track | got missing.csv | expected a file that exists |
check {{three.csv}} | three.csv: points | got 3 with 3 different | expected at least 4 different ones |
check {{commas.csv}} | commas.csv:2: x_m | got 1,000.5 | expected a finite number with a decimal point |
check {{key.yaml}} | key.yaml:3: tracking_mpc.horizon_stepz | got an unknown key | expected one of | (did you mean tracking_mpc.horizon_steps?)
check {{track.yaml}} | track.yaml:1: track | got "lakesite" | expected a file or one of | (did you mean lakeside?)
tune --evaluations many | --evaluations | got many | expected a whole number in [1, 10000000] | {USAGE}
campaign --faults foo | --faults | got foo | expected one of `chicane list faults` |
drive --fast --set mass=900 | mass | got an unknown key | expected one of `chicane list parameters` | (did you mean vehicle.mass_kg?)
merge none.jsonl -o all.jsonl | none.jsonl: file | got none | expected a file |
lane-change --car f1tenth | chicane lane-change | got --car | expected one of its options | (did you mean --cars?)
""".splitlines()]


class Mistakes(InFolder):
    def setUp(self):
        super().setUp()
        for name, text in FILES.items():
            (self.at / name).write_text(text)

    def said(self, command):
        words = [word.strip("{}") if word.startswith("{") else word for word in shlex.split(command)]
        code, out, err = run(*words, cwd=self.at)
        self.assertEqual(out if code == 2 else "", "")
        return code, err

    def test_each_is_named_with_its_remedy(self):
        self.assertGreaterEqual(len(MISTAKES), 50)
        for command, place, got, expected, *remedy in MISTAKES:
            with self.subTest(command):
                code, err = self.said(command)
                self.assertEqual(code, 2, err)
                message = err.replace(f"{self.at}/", "")
                for part in (place.strip(), got.strip(), expected.rstrip(" |"), *(part.rstrip(" |") for part in remedy)):
                    self.assertIn(part, message)
                for raw in ("Could not convert", "1 required", "not in range", "At Most", "requires", "excludes", "{false}"):
                    self.assertNotIn(raw, message)

    def test_help_has_no_raw_words(self):
        for command in ("drive", "serve", "replay", "league"):
            code, text, _ = run(command, "--help")
            self.assertEqual(code, 0)
            self.assertNotIn("{false}", text)
        self.assertIn("-o,--output", run("replay", "--help")[1])


if __name__ == "__main__":
    unittest.main()
