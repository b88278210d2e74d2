# SPDX-License-Identifier: MIT
"""Both ends of the simulator's socket, as simply as strangers write them: for edge_cases_test.py."""
import base64
import hashlib
import json
import math
import os
import socket
import struct
import threading
import time


def frame(text, mask=b""):
    """A text frame of RFC 6455, up to 64 KiB."""
    payload = text.encode()
    size = len(payload)
    flag = 0x80 if mask else 0
    head = bytes([0x81, flag | size]) if size < 126 else bytes([0x81, flag | 126]) + struct.pack(">H", size)
    return head + mask + (bytes(c ^ mask[i % 4] for i, c in enumerate(payload)) if mask else payload)


class Stream:
    def __init__(self, connection):
        self.connection = connection
        self.buffer = b""

    def until(self, end):
        while end not in self.buffer:
            self.fill()
        text, self.buffer = self.buffer.split(end, 1)
        return text.decode(errors="replace")

    def take(self, count):
        while len(self.buffer) < count:
            self.fill()
        taken, self.buffer = self.buffer[:count], self.buffer[count:]
        return taken

    def fill(self):
        got = self.connection.recv(65536)
        if not got:
            raise EOFError
        self.buffer += got

    def message(self):
        """The text of the next frame; empty for all but text."""
        first, second = self.take(2)
        size = second & 0x7F
        if size == 126:
            size = struct.unpack(">H", self.take(2))[0]
        mask = self.take(4) if second & 0x80 else b"\0\0\0\0"
        payload = bytes(c ^ mask[i % 4] for i, c in enumerate(self.take(size)))
        return payload.decode(errors="replace") if first & 15 == 1 else ""


class WebSocket:
    """A simulator's end."""

    def __init__(self, port, host="127.0.0.1"):
        self.connection = socket.create_connection(("127.0.0.1", port), 10)
        key = base64.b64encode(os.urandom(16)).decode()
        self.connection.sendall(
            f"GET /socket.io/?EIO=4&transport=websocket HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        self.stream = Stream(self.connection)
        self.is_open = " 101 " in self.stream.until(b"\r\n\r\n").split("\r\n")[0]

    def send(self, text):
        self.connection.sendall(frame(text, os.urandom(4)))

    def receive(self):
        text = ""
        while not text.startswith("42"):
            text = self.stream.message()
        return text

    def close(self):
        self.connection.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def telemetry(x=-40.62, y=108.73, psi=3.733651, speed=20.0, ptsx=None, ptsy=None, thr=0.0):
    """As the original sends it; numbers that are not finite become NaN and Infinity, as Python writes them."""
    turned = (2.5 * math.pi - psi) % (2 * math.pi) if math.isfinite(psi) else 0.0
    data = {"ptsx": ptsx or [-32.16173, -43.49173, -61.09, -78.29172, -93.05002, -107.7717],
            "ptsy": ptsy or [113.361, 105.941, 92.88499, 78.73102, 65.34102, 50.57938],
            "psi_unity": turned, "psi": psi, "x": x, "y": y, "steering_angle": 0.0, "throttle": thr, "speed": speed}
    return "42" + json.dumps(["telemetry", data], separators=(",", ":"))


def steering_of(message):
    answer = json.loads(message[2:])[1]
    return {"steer": answer["steering_angle"], "throttle": answer["throttle"], "plan": len(answer["mpc_x"])}


class Bicycle:
    """A simulator's car on a closed road of waypoints, in real time, with six waypoints in each message."""

    def __init__(self, road):
        self.road = road
        self.time = 0.0
        self.put(0)

    def put(self, i):
        """Standing at a waypoint, along the road."""
        (self.x, self.y), (x, y) = self.road[i], self.road[(i + 1) % len(self.road)]
        self.psi = math.atan2(y - self.y, x - self.x)
        self.speed = self.steer = self.throttle = 0.0

    def message(self):
        nearest = min(range(len(self.road)), key=lambda i: math.dist(self.road[i], (self.x, self.y)))
        ahead = [self.road[(nearest - 1 + i) % len(self.road)] for i in range(6)]
        return telemetry(self.x, self.y, self.psi, self.speed / 0.44704, [p[0] for p in ahead], [p[1] for p in ahead], max(0.0, self.throttle))

    def move(self, seconds):
        steps = max(1, int(seconds / 0.01))
        for _ in range(steps):
            push = self.throttle * 5.43 - 0.104 * self.speed if self.throttle >= 0 else max(-13.0, 218 * self.throttle)
            self.speed = max(0.0, self.speed + push * seconds / steps)
            self.psi += self.speed / 2.67 * math.tan(-self.steer * math.radians(25)) * seconds / steps
            self.x += self.speed * math.cos(self.psi) * seconds / steps
            self.y += self.speed * math.sin(self.psi) * seconds / steps
        self.time += seconds

    def drive(self, simulator, is_over):
        while not is_over():
            began = time.monotonic()
            simulator.send(self.message())
            answer = steering_of(simulator.receive())
            time.sleep(0.02)
            self.move(min(time.monotonic() - began, 0.33))
            self.steer, self.throttle = answer["steer"], answer["throttle"]


class Controller:
    """A controller's end that answers wrongly, in one of several ways."""

    ANSWERS = {"degrees": ("12.5", "0.1"), "nan": ("NaN", "0.1"), "rest": ("0", "0")}

    def __init__(self, mode, port=0):
        self.mode = mode
        self.listener = socket.create_server(("127.0.0.1", port))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        try:
            while True:
                threading.Thread(target=self.serve, args=(self.listener.accept()[0],), daemon=True).start()
        except OSError:
            return

    def serve(self, connection):
        try:
            stream = Stream(connection)
            head = stream.until(b"\r\n\r\n")
            key = next(line.split(": ")[1] for line in head.split("\r\n") if line.lower().startswith("sec-websocket-key"))
            accept = base64.b64encode(hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()).decode()
            connection.sendall("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                               f"Sec-WebSocket-Accept: {accept}\r\n\r\n".encode())
            while True:
                if stream.message().startswith('42["telemetry"'):
                    steer, throttle = self.ANSWERS[self.mode]
                    connection.sendall(frame('42["steer",{"mpc_x":[],"mpc_y":[],"next_x":[],"next_y":[],"steering_angle":'
                                             + steer + ',"throttle":' + throttle + '}]'))
        except (EOFError, OSError):
            connection.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.listener.close()
