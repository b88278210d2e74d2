#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A controller in another language: it speaks the original simulator's protocol (docs/protocol.md) and needs nothing but Python.

    examples/05_any_language.py --port 4567 --latency-ms 100        the controller
    chicane simulate --track lakeside --laps 1                      the car, in another terminal
    chicane league mine.yaml --server "examples/05_any_language.py --port {port} --latency-ms {latency_ms}"
"""
import argparse
import asyncio
import base64
import hashlib
import json
import math

FULL_LOCK_RAD = math.radians(25)
MPS_PER_MPH = 0.44704


# [controller]
def steer_and_throttle(car, speed_mps):
    """Along the circle through the fourth waypoint, at a steady speed. Steering is a share of the lock, positive to the right."""
    dx, dy = car["ptsx"][3] - car["x"], car["ptsy"][3] - car["y"]
    to_the_left = math.cos(car["psi"]) * dy - math.sin(car["psi"]) * dx
    angle = 5.7 * to_the_left / max(1.0, dx * dx + dy * dy)  # twice the wheelbase, by the curvature of the circle
    steer = max(-1.0, min(1.0, -angle / FULL_LOCK_RAD))
    throttle = max(-0.1, min(1.0, 0.2 * (speed_mps - car["speed"] * MPS_PER_MPH) + 0.2))
    return steer, throttle
# [/controller]


async def read_text(reader):
    """The next text message of a WebSocket client; None when it has gone."""
    while True:
        first, size = await reader.readexactly(2)
        size &= 0x7F
        if size == 126:
            size = int.from_bytes(await reader.readexactly(2), "big")
        elif size == 127:
            size = int.from_bytes(await reader.readexactly(8), "big")
        mask = await reader.readexactly(4)
        payload = bytes(byte ^ mask[i % 4] for i, byte in enumerate(await reader.readexactly(size)))
        if first & 0x0F == 8:
            return None
        if first & 0x0F == 1:
            return payload.decode()


def frame(text):
    """A text message of a server."""
    payload = text.encode()
    size = bytes([len(payload)]) if len(payload) < 126 else b"\x7e" + len(payload).to_bytes(2, "big")
    return b"\x81" + size + payload


async def serve(reader, writer, options):
    head = (await reader.readuntil(b"\r\n\r\n")).decode()
    lines = (line.split(":", 1) for line in head.splitlines() if ":" in line)
    key = {name.lower(): value.strip() for name, value in lines}["sec-websocket-key"]
    accept = base64.b64encode(hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()).decode()
    writer.write(f"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {accept}\r\n\r\n".encode())
    try:
        while (text := await read_text(reader)) is not None:
            if not text.startswith('42["telemetry",{'):
                continue
            steer, throttle = steer_and_throttle(json.loads(text[2:])[1], options.speed_mps)
            answer = {"mpc_x": [], "mpc_y": [], "next_x": [], "next_y": [], "steering_angle": steer, "throttle": throttle}
            await asyncio.sleep(options.latency_ms / 1000)
            writer.write(frame("42" + json.dumps(["steer", answer])))
            await writer.drain()
    except (asyncio.IncompleteReadError, ConnectionError):
        pass
    writer.close()


async def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--port", type=int, default=4567)
    parser.add_argument("--latency-ms", type=float, default=100.0)
    parser.add_argument("--speed-mps", type=float, default=12.0)
    options = parser.parse_args()
    server = await asyncio.start_server(lambda reader, writer: serve(reader, writer, options), "127.0.0.1", options.port)
    async with server:
        await server.serve_forever()


if __name__ == "__main__":
    asyncio.run(main())
