#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The textbook in Python: the blocks of 00_textbook_mpc.cpp, which explains them and has exercises, in the same order.

    examples/textbook_mpc.py [port 4567] [mph 40] [sleep_ms 100]   the controller; needs numpy and the module chicane (docs/python.md)
    chicane simulate --track original-lake --laps 2                the car, in another terminal; or the original game
"""
import base64
import contextlib
import hashlib
import json
import socket
import sys
import time

import numpy as np

import chicane as ch

N = 10                                   # states in the plan
dt = 0.1                                 # time from one to the next [s]
Lf = 2.67                                # length in psi' = v / Lf * delta [m]
latency = 0.1                            # time from telemetry to the wheels, as the controller assumes it [s]
max_steer, mps_per_mph = np.radians(25), 0.44704


# ---- 1 Telemetry: {"ptsx": [six numbers], "ptsy": [...], "x": ..., "y": ..., "psi": ..., "speed": mph, "steering_angle": rad, ...}
# ---- 2 Roll-forward: x += v cos(psi) L, y += v sin(psi) L, psi -= v / Lf * delta * L, v += a L, with v in m/s but for the last
def roll_forward(x, y, psi, v, delta, a):
    metres = v * mps_per_mph * latency
    return x + metres * np.cos(psi), y + metres * np.sin(psi), psi - metres / Lf * delta, v + a * latency


# ---- 3 The car's frame: x' = dx cos(psi) + dy sin(psi), y' = dy cos(psi) - dx sin(psi)
def to_car_frame(ptsx, ptsy, x, y, psi):
    dx, dy = np.array(ptsx) - x, np.array(ptsy) - y
    return dx * np.cos(psi) + dy * np.sin(psi), dy * np.cos(psi) - dx * np.sin(psi)


# ---- 4 The line: f(x) = c0 + c1 x + c2 x^2 + c3 x^3 by Householder QR
def polyfit(x, y):
    q, r = np.linalg.qr(np.vander(x, 4, increasing=True))
    return np.linalg.solve(r, q.T @ y)

def polyeval(c, x):
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]))

def slope(c, x):
    return c[1] + x * (2 * c[2] + x * 3 * c[3])


# ---- 5 The optimal control problem. p: the cubic's four coefficients and the reference speed. v is in mph, used as if it were m/s.
mpc = ch.Problem(nx=8, nu=2, horizon=N - 1, parameters=5)

@mpc.dynamics
def model(state, inputs, p):
    x, y, psi, v, cte, epsi, delta_before, a_before = state
    delta, a = inputs
    psi_des = np.arctan(slope(p, x))
    return [x + v * np.cos(psi) * dt,                           # x'    = x + v cos(psi) dt
            y + v * np.sin(psi) * dt,                           # y'    = y + v sin(psi) dt
            psi - v / Lf * delta * dt,                          # psi'  = psi - v / Lf * delta * dt
            v + a * dt,                                         # v'    = v + a dt
            polyeval(p, x) - y + v * np.sin(epsi) * dt,         # cte'  = f(x) - y + v sin(epsi) dt
            psi - psi_des - v / Lf * delta * dt,                # epsi' = psi - psi_des - v / Lf * delta * dt
            delta, a]

W_CTE, W_EPSI, W_V, W_DELTA, W_A, W_DDELTA, W_DA = 200, 200, 0.1, 1, 1, 10, 1

@mpc.cost
def cost(state, inputs, p, k):
    x, y, psi, v, cte, epsi, delta_before, a_before = state
    delta, a = inputs
    has_before = ch.where(k > 0, 1, 0)                          # changes count inside the plan only
    return [W_CTE**0.5 * cte, W_EPSI**0.5 * epsi, W_V**0.5 * (v - p[4]), W_DELTA**0.5 * delta, W_A**0.5 * a,
            has_before * W_DDELTA**0.5 * (delta - delta_before), has_before * W_DA**0.5 * (a - a_before)]

mpc.terminal(lambda state, p: [W_CTE**0.5 * state[4], W_EPSI**0.5 * state[5], W_V**0.5 * (state[3] - p[4])])
mpc.bounds(u=([-max_steer, -1], [max_steer, 1]))


# ---- 6 One cycle. Steering as a share of 25 degrees, right positive, as in the model.
def answer(car, v_ref):
    delta, a = car["steering_angle"], car["throttle"]
    x, y, psi, v = roll_forward(car["x"], car["y"], car["psi"], car["speed"], delta, a)
    c = polyfit(*to_car_frame(car["ptsx"], car["ptsy"], x, y, psi))
    plan = mpc.solve([0, 0, 0, v, polyeval(c, 0), -np.arctan(slope(c, 0)), 0, 0], [*c, v_ref])
    seen = np.arange(0, 61, 5.0)
    return {"steering_angle": plan.u[0, 0] / max_steer, "throttle": plan.u[0, 1], "mpc_x": list(plan.x[:, 0]), "mpc_y": list(plan.x[:, 1]),
            "next_x": list(seen), "next_y": list(polyeval(c, seen))}


# ---- 7 The socket: a WebSocket server in few lines (RFC 6455). 42["steer",{...}] for each 42["telemetry",{...}].
def read_text(stream):
    head = stream.read(2)
    if len(head) < 2 or head[0] & 15 == 8:                      # the simulator has gone
        return None
    size = head[1] & 127
    mask_and_text = stream.read(4 + (int.from_bytes(stream.read(2), "big") if size == 126 else size))
    return bytes(byte ^ mask_and_text[i % 4] for i, byte in enumerate(mask_and_text[4:])).decode()

def talk(client, stream, v_ref, sleep_s):
    key = next(line.split()[1] for line in list(iter(stream.readline, b"\r\n")) if line.lower().startswith(b"sec-websocket-key:"))
    accept = base64.b64encode(hashlib.sha1(key + b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11").digest())
    client.sendall(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: " + accept + b"\r\n\r\n")
    while (text := read_text(stream)) is not None:
        if text.startswith('42["telemetry"'):
            car = json.loads(text[2:])[1]
            event = ["manual", {}] if car is None else ["steer", answer(car, v_ref)]
            time.sleep(sleep_s)
            reply = ("42" + json.dumps(event)).encode()
            client.sendall(b"\x81" + (bytes([len(reply)]) if len(reply) < 126 else b"\x7e" + len(reply).to_bytes(2, "big")) + reply)


if __name__ == "__main__":
    port, mph, sleep_ms = map(int, sys.argv[1:] + ["4567", "40", "100"][len(sys.argv) - 1:])
    with socket.create_server(("127.0.0.1", port)) as door:
        while True:
            with contextlib.suppress(ConnectionError), door.accept()[0] as client, client.makefile("rb") as stream:
                talk(client, stream, mph, sleep_ms / 1000)
