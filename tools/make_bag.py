#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes a bag of ROS 2 with odometry and commands alone of a recording of ours, as a team's car writes it.

    chicane drive --fast --car mine.yaml --record run.mcap ...
    tools/make_bag.py run.mcap BAG [--storage mcap|sqlite3] [--seed N] [--position-noise-m X] [--heading-noise-deg X] [--speed-noise-mps X]

BAG becomes a folder with metadata.yaml and BAG_0.mcap or BAG_0.db3: /odom (nav_msgs/Odometry, of the rear axle) and /drive
(ackermann_msgs/AckermannDriveStamped). Noise is added to what the recording knows exactly. Recordings made by --compress are not read.
"""
import argparse
import math
import pathlib
import random
import sqlite3
import struct
import sys
import zlib

ODOMETRY, DRIVE = "nav_msgs/msg/Odometry", "ackermann_msgs/msg/AckermannDriveStamped"
START_NS = 1_700_000_000_000_000_000  # a day on which bags are recorded


def text_at(data, at):
    size, = struct.unpack_from("<I", data, at)
    return data[at + 4:at + 4 + size].decode(), at + 4 + size


def records(data, at, end):
    while at + 9 <= end:
        opcode, size = data[at], struct.unpack_from("<Q", data, at + 1)[0]
        yield opcode, data[at + 9:at + 9 + size]
        at += 9 + size


def messages(path):
    """(topic, log time [ns], CDR) of an MCAP file without compression."""
    data = path.read_bytes()
    if data[:5] != b"\x89MCAP":
        raise SystemExit(f"{path}: file: got other content, expected an MCAP file")
    topics = {}

    def of(opcode, body):
        if opcode == 0x04:  # channel
            topics[struct.unpack_from("<H", body)[0]] = text_at(body, 4)[0]
        elif opcode == 0x05:  # message
            channel, _, log_time = struct.unpack_from("<HIQ", body)
            yield topics[channel], log_time, body[22:]
        elif opcode == 0x06:  # chunk
            compression, at = text_at(body, 28)
            if compression:
                raise SystemExit(f"{path}: compression: got {compression}, expected none (record without --compress)")
            for inner in records(body, at + 8, len(body)):
                yield from of(*inner)

    for record in records(data, 8, len(data)):
        yield from of(*record)


class Cdr:
    """Little-endian CDR; numbers are aligned to their size from behind the four bytes of the header."""
    def __init__(self, data=b"\0\1\0\0"):
        self.data, self.at = bytearray(data), 4

    def align(self, size):
        return -(self.at - 4) % size

    def put(self, kind, *values):
        for value in values:
            self.data += bytes(self.align(struct.calcsize(kind))) + struct.pack("<" + kind, value)
            self.at = len(self.data)
        return self

    def text(self, value):
        raw = value.encode() + b"\0"
        self.put("I", len(raw))
        self.data += raw
        self.at = len(self.data)
        return self

    def header(self, time_ns, frame):
        return self.put("i", time_ns // 10**9).put("I", time_ns % 10**9).text(frame)

    def get(self, kind, count=1):
        values = []
        for _ in range(count):
            self.at += self.align(struct.calcsize(kind))
            values += struct.unpack_from("<" + kind, self.data, self.at)
            self.at += struct.calcsize(kind)
        return values if count > 1 else values[0]

    def skip_text(self):
        size = self.get("I")
        self.at += size

    def time(self):
        time_ns = self.get("i") * 10**9 + self.get("I")
        self.skip_text()
        return time_ns


def read(path, noise, rng):
    """[(time [ns], topic, CDR)]: what the car measured and its commands."""
    found = []
    for topic, _, data in messages(path):
        cdr = Cdr(data)
        if topic == "/odom":
            time = cdr.time()
            cdr.skip_text()
            x, y, _, _, _, qz, qw = cdr.get("d", 7)
            cdr.get("d", 36)
            vx, vy, _, _, _, r = cdr.get("d", 6)
            psi = 2.0 * math.atan2(qz, qw) + rng.gauss(0.0, noise.heading)
            out = Cdr().header(START_NS + time, "odom").text("base_link")
            out.put("d", x + rng.gauss(0.0, noise.position), y + rng.gauss(0.0, noise.position), 0.0, 0.0, 0.0, math.sin(psi / 2), math.cos(psi / 2))
            out.put("d", *[0.0] * 36, vx + rng.gauss(0.0, noise.speed), vy, 0.0, 0.0, 0.0, r + rng.gauss(0.0, noise.yaw_rate), *[0.0] * 36)
        elif topic == "/drive":
            time = cdr.time()
            steer, _, speed, acceleration, _ = cdr.get("f", 5)
            out = Cdr().header(START_NS + time, "base_link").put("f", steer, 0.0, speed, acceleration, 0.0)
        else:
            continue
        found.append((START_NS + time, topic, bytes(out.data)))
    if not found:
        raise SystemExit(f"{path}: got no /odom and no /drive, expected a recording of chicane drive --record")
    return found


TOPICS = {"/odom": ODOMETRY, "/drive": DRIVE}


def write_mcap(path, found):
    def text(value):
        raw = value.encode()
        return struct.pack("<I", len(raw)) + raw

    def record(opcode, body):
        return bytes([opcode]) + struct.pack("<Q", len(body)) + body

    inner = b""
    for number, (topic, kind) in enumerate(TOPICS.items(), 1):
        inner += record(0x03, struct.pack("<H", number) + text(kind) + text("ros2msg") + struct.pack("<I", 0))
        inner += record(0x04, struct.pack("<HH", number, number) + text(topic) + text("cdr") + struct.pack("<I", 0))
    numbers = {topic: number for number, topic in enumerate(TOPICS, 1)}
    for sequence, (time, topic, data) in enumerate(found):
        inner += record(0x05, struct.pack("<HIQQ", numbers[topic], sequence, time, time) + data)
    chunk = struct.pack("<QQQI", found[0][0], found[-1][0], len(inner), zlib.crc32(inner)) + text("") + struct.pack("<Q", len(inner)) + inner
    path.write_bytes(b"\x89MCAP0\r\n" + record(0x01, text("ros2") + text("libmcap 1.1.0")) + record(0x06, chunk) +
                     record(0x0F, struct.pack("<I", 0)) + record(0x02, struct.pack("<QQI", 0, 0, 0)) + b"\x89MCAP0\r\n")


def write_sqlite(path, found):
    path.unlink(missing_ok=True)
    bag = sqlite3.connect(path)
    bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL, "
                "offered_qos_profiles TEXT NOT NULL)")
    bag.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    numbers = {topic: number for number, topic in enumerate(TOPICS, 1)}
    bag.executemany("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", [(numbers[topic], topic, kind) for topic, kind in TOPICS.items()])
    bag.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", [(numbers[topic], time, data) for time, topic, data in found])
    bag.commit()
    bag.close()


def write_metadata(path, file, storage, found):
    lines = ["rosbag2_bagfile_information:", "  version: 5", f"  storage_identifier: {storage}", "  duration:",
             f"    nanoseconds: {found[-1][0] - found[0][0]}", "  starting_time:", f"    nanoseconds_since_epoch: {found[0][0]}",
             f"  message_count: {len(found)}", "  topics_with_message_count:"]
    for topic, kind in TOPICS.items():
        lines += ["    - topic_metadata:", f"        name: {topic}", f"        type: {kind}", "        serialization_format: cdr",
                  '        offered_qos_profiles: ""', f"      message_count: {sum(each[1] == topic for each in found)}"]
    lines += ['  compression_format: ""', '  compression_mode: ""', "  relative_file_paths:", f"    - {file}"]
    path.write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog=__doc__.partition("\n")[2],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("bag", type=pathlib.Path)
    parser.add_argument("--storage", choices=("mcap", "sqlite3"), default="mcap")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--position-noise-m", dest="position", type=float, default=0.0)
    parser.add_argument("--heading-noise-deg", dest="heading", type=lambda text: math.radians(float(text)), default=0.0)
    parser.add_argument("--speed-noise-mps", dest="speed", type=float, default=0.0)
    parser.add_argument("--yaw-rate-noise-radps", dest="yaw_rate", type=float, default=0.0)
    options = parser.parse_args()
    found = read(options.recording, options, random.Random(options.seed))
    options.bag.mkdir(parents=True, exist_ok=True)
    ending = "mcap" if options.storage == "mcap" else "db3"
    file = f"{options.bag.name}_0.{ending}"
    (write_mcap if options.storage == "mcap" else write_sqlite)(options.bag / file, found)
    write_metadata(options.bag / "metadata.yaml", file, options.storage, found)
    print(f"{options.bag / file}: {len(found)} messages in {(found[-1][0] - found[0][0]) / 1e9:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
