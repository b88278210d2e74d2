#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shows that a change leaves the product as it was: runs the commands of tests/golden/same_product/things.txt and hashes what they give.

    tools/same_product.py PROGRAM -o FILE         writes FILE, a line for each output
    tools/same_product.py PROGRAM --against FILE  prints each line that differs from FILE; exit code 1 where one does
      --sample                                    only what is quick and needs no sockets

A line has the exit code, the state_hash of a run, and lines and hash of standard output, standard error or a file that was written; of a
recording, messages and hash of each topic. Masked are clock times, sizes of recordings, paths, the digest of the program's sources, and
the web program in a page. Of a run in real time only the keys and words of the report count. The hashes are those of fused arithmetic:
exit code 77 where the program has only the plain one. What is not built beside PROGRAM (Python's module, chicane-ros) is left out.
"""
import argparse
import concurrent.futures
import hashlib
import importlib
import json
import os
import re
import shlex
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
THINGS = ROOT / "tests/golden/same_product/things.txt"
LAP = ("drive", "--fast", "--json", "--set", "time_limit_s=1")
PYTHON = "import hashlib\nimport chicane as ch\nhash_of = lambda array: hashlib.sha256(array.tobytes()).hexdigest()[:16]\n"
MASKS = ((r"[\d./ ]+µs", " T µs"), (r" in [\d.]+ s \([\d.]+ times real time\)", " in T"), (r"\d[\d.]* [kM]B\b", "SIZE"),
         (r'("(?:p50|p99|p999|max|wall_time_s|deadline_misses)": ?)[\d.e+-]+', r"\1T"), (r"\d+ late\b", "T late"), (r"found in [\d.]+ s", "found in T"),
         (r'("solve")(, "[\d.]+")+', r"\1"), (r"\([0-9a-f]{12}\)", "(DIGEST)"),
         (r"(?m)^(planning the lap: .*|limit: .*, turn \d+, .*|\d+ of \d+ .* a second, .*)\n", ""))  # progress, every ten seconds
SIZES = {"bool": 1, "int8": 1, "uint8": 1, "int32": 4, "uint32": 4, "uint64": 8, "float64": 8}


def digest(*parts):
    return hashlib.sha256(b"".join(parts)).hexdigest()[:16]


def hashed(text):
    return f"{text.count(chr(10))} lines {digest(text.encode())}" if text else "nothing"


def records(data):
    """Kind and body of each record of an MCAP file; of those in its chunks, too, where they are not compressed."""
    at = 0
    while at + 9 <= len(data):
        kind, size = struct.unpack_from("<BQ", data, at)
        body = data[at + 9:at + 9 + size]
        at += 9 + size
        if kind == 6 and struct.unpack_from("<I", body, 28)[0] == 0:
            yield from records(body[40:])
        else:
            yield kind, body


def end_of_step_time(definition):
    """Where the eight bytes of the control step's clock time end in the record of a message: all before is of fixed size."""
    at = 22 + 4  # the headers of MCAP and CDR
    for kind, name in re.findall(r"^([\w/]+) (\w+) *(?:#.*)?$", definition, re.MULTILINE):
        at += 8 if kind == "builtin_interfaces/Time" else (26 - at) % SIZES[kind] + SIZES[kind]
        if name.startswith("step_time"):
            return at
    raise ValueError("a message without step_time")


def recording(data):
    """Messages and hash of each topic, schema and times included, and of the attachments."""
    schemas, topics, found = {}, {}, {}
    for kind, body in records(data[8:]):
        number = struct.unpack_from("<H", body)[0]
        if kind == 3:
            schemas[number] = body[2:]
        elif kind == 4:
            schema, size = struct.unpack_from("<HI", body, 2)
            topics[number] = body[8:8 + size].decode(), schemas[schema]
            found.setdefault(topics[number][0], [schemas[schema]])
        elif kind == 5:
            name, schema = topics[number]
            if name in ("/chicane/frame", "/chicane/step"):
                end = end_of_step_time(schema[schema.index(b"ros2msg") + 11:].decode())
                body = body[:end - 8] + body[end:]
            elif name == "/diagnostics":
                body = re.sub(rb"(step_time_us\0)\0{0,3}.\0\0\0[\d.]+\0+", rb"\1", body, flags=re.DOTALL)
            found[name].append(body[2:])
        elif kind == 9:
            found.setdefault("attachments", [b""]).append(body)
    return {name: f"{len(messages) - 1} messages {digest(*messages)}" for name, messages in sorted(found.items())}


def masked(text, places):
    for pattern, by in (*((re.escape(str(place)), name) for place, name in places), *MASKS):
        text = re.sub(pattern, by, text)
    return text


def contents(file, places):
    """Value of each part of a file. Of a picture only its size: versions of zlib pack it differently."""
    data = file.read_bytes()
    if file.suffix in (".mcap", ".png"):
        return recording(data) if file.suffix == ".mcap" else {"size": data[16:24].hex()}
    page = re.search(rb'id="chicane-report">(.*?)</script>', data, re.DOTALL)
    if page is None:
        lines = masked(data.decode(), places).splitlines(keepends=True)
        return {"text": hashed("".join(sorted(lines) if file.suffix == ".jsonl" else lines))}  # results: in the order in which runs ended
    report = json.loads(page[1])
    for each in (run for log in report.get("logs", []) for run in log["runs"]):
        each.pop("steps", None)  # times of this machine
        each["frames"].pop("step_time_us", None)
    return {"report": hashed(masked(json.dumps(report), places))}


def process(program, python, words):
    """The words of a process; None where it is not built."""
    if words.startswith("py "):
        return ["/usr/bin/python3", "-c", PYTHON + words[3:]] if python.exists() else None
    if words.startswith("ros -") and "--help" not in words and not (program.parent / "chicane-ros").exists():
        return None
    return [program, *shlex.split(words.replace("ROOT", str(ROOT)).replace("PROGRAM", str(program)))]


def what_was_said(done, is_in_real_time, places):
    out, err = masked(done.stdout, places), masked(done.stderr, places)
    if is_in_real_time:
        kept = {re.sub(r"-?\d[\d.e+-]*", "N", line) for line in out.splitlines() if "state_hash" not in line}
        return f"exit {done.returncode}, words {hashed(chr(10).join(sorted(kept)))}"
    state = re.search(r'"state_hash": "(\w+)"', out)
    return f"exit {done.returncode}, " + (f"state {state[1]}, " if state else "") + f"out {hashed(out)}, err {hashed(err)}"


def outcome(program, name, commands, files):
    """Value of each output of a thing; none where a part of it is not built."""
    found, others, python = {}, [], program.parents[min(2, len(program.parents) - 1)] / "python"
    with tempfile.TemporaryDirectory() as cache, tempfile.TemporaryDirectory() as folder:
        places = ((folder, "HERE"), (program, "PROGRAM"), (ROOT, "ROOT"))
        for file, text in files.items():
            Path(folder, file).write_text(text, encoding="utf-8")
        where = {"cwd": folder, "env": os.environ | {"XDG_CACHE_HOME": cache, "CHICANE_DATA_DIR": str(ROOT / "data"), "PYTHONPATH": str(python)}}
        for line in commands:
            words = line.lstrip("&~")
            to_run = process(program, python, words)
            if to_run is None:
                print(f"{name} is not built")
                return {}
            if line.startswith("&"):
                others.append(subprocess.Popen(to_run, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **where))
            else:
                done = subprocess.run(to_run, capture_output=True, text=True, encoding="utf-8", timeout=600, **where)
                found[f"{name}: {words}"] = what_was_said(done, line.startswith("~"), places)
        for other in others:
            other.terminate()
            other.wait(60)
        for file in sorted(each for each in Path(folder).iterdir() if each.name not in files):
            found |= {f"{name}: {file.name}:{part}": value for part, value in contents(file, places).items()}
    return found


def things(program, is_sample):
    """Name, commands and files of each."""
    for name, commands in re.findall(r"^(\w.*)\n((?:  .*\n)+)", THINGS.read_text(encoding="utf-8"), re.MULTILINE):
        if not (is_sample and name.endswith("(slow)")):
            yield name, [line.strip() for line in commands.splitlines()], {}
    sys.path.insert(0, str(ROOT / "tests/apps"))
    sys.argv[1:] = [str(program)]  # as the test wants it
    mistakes = importlib.import_module("mistakes_test")
    # The test apps.mistakes types them, too.
    yield "mistakes", [each[0].replace("{", "").replace("}", "") for each in mistakes.MISTAKES if not is_sample], mistakes.FILES


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda path: Path(path).resolve())
    parser.add_argument("-o", "--output", type=Path)
    parser.add_argument("--against", type=Path)
    parser.add_argument("--sample", action="store_true")
    options = parser.parse_args()
    if '"arithmetic": "plain"' in subprocess.run([options.program, *LAP], cwd=ROOT, capture_output=True, text=True).stdout:
        print(f"{options.program} has no fused arithmetic on this machine: nothing is compared")
        return 77
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(outcome, options.program, *thing) for thing in things(options.program, options.sample)]
        found = {key: value for job in jobs for key, value in job.result().items()}
    if options.output:
        options.output.write_text("".join(f"{key} = {value}\n" for key, value in found.items()), encoding="utf-8")
    if not options.against:
        return 0
    lines = (line.rsplit(" = ", 1) for line in options.against.read_text(encoding="utf-8").splitlines())
    names = {key.split(": ")[0] for key in found}
    expected = {key: value for key, value in lines if key.split(": ")[0] in names}
    differing = [key for key in expected | found if expected.get(key) != found.get(key)]
    for key in differing:
        print(f"{key}\n  expected {expected.get(key, 'none')}\n  got      {found.get(key, 'none')}")
    print(f"{len(differing)} of {len(expected)} outputs differ")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
