#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the figures of docs/plants*.md from the CSV files of chicane_plant_report.

    build/release/studies/tables/chicane_plant_report csv /tmp && /usr/bin/python3 studies/tables/plot_plants.py /tmp docs/figures
"""
import argparse
import csv
from collections import defaultdict

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("source", help="folder of the CSV files")
parser.add_argument("target", help="folder of the figures")
options = parser.parse_args()  # before an import that may fail

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "chicane"  # the same bytes each time
matplotlib.rcParams["svg.fonttype"] = "none"
import matplotlib.pyplot as plt  # noqa: E402


def read(path):
    """Columns of a CSV file: numbers where they are numbers."""
    columns = defaultdict(list)
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            for key, value in row.items():
                try:
                    columns[key].append(float(value))
                except ValueError:
                    columns[key].append(value)
    return columns


def save(figure, path):
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    plt.close(figure)


def select(table, key, value, column):
    return [v for k, v in zip(table[key], table[column]) if k == value]


def longitudinal(source, target):
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), sharey=True)
    for axis, name, title in zip(axes, ("udacity", "road_car"), ("udacity", "road-car")):
        table = read(f"{source}/{name}_longitudinal.csv")
        for phase, color, label in (("drive", "tab:blue", "throttle 1"), ("brake", "tab:red", "throttle −1")):
            axis.plot(select(table, "phase", phase, "speed_mps"), select(table, "phase", phase, "acceleration_mps2"),
                      ".", ms=3, color=color, label=f"plant, {label}")
        axis.set(title=title, xlabel="speed [m/s]")
        axis.axhline(0, color="0.7", lw=0.6)
    speeds = [5, 50]
    axes[0].plot(speeds, [5.43 - 0.104 * v for v in speeds], "k-", lw=0.8, label="5.43 − 0.104 v (logs)")
    axes[0].plot([8, 40], [-(6.29 + 0.142 * v) for v in (8, 40)], "k--", lw=0.8, label="−(6.29 + 0.142 v) (logs)")
    axes[0].set_ylabel("acceleration [m/s²]")
    for axis in axes:
        axis.legend(fontsize=7)
    save(figure, f"{target}/plant_longitudinal.svg")


def yaw_steps(source, target):
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6))
    for axis, name, title in zip(axes, ("udacity", "road_car"), ("udacity", "road-car")):
        table = read(f"{source}/{name}_yaw_steps.csv")
        for speed in sorted(set(table["speed_mps"])):
            axis.plot(select(table, "speed_mps", speed, "time_s"), select(table, "speed_mps", speed, "yaw_gain_per_s"),
                      label=f"{speed:.0f} m/s")
        axis.set(title=title, xlabel="time after a 0.01 rad step [s]")
        axis.legend(fontsize=7)
    axes[0].set_ylabel("yaw rate / steering angle [1/s]")
    save(figure, f"{target}/plant_yaw_steps.svg")


def modes(source, target):
    table = read(f"{source}/udacity_modes.csv")
    figure, axis = plt.subplots(figsize=(5.5, 3.6))
    axis.plot(table["speed_mps"], table["mode_1_per_s"], color="tab:blue", label="plant, its two yaw modes")
    axis.plot(table["speed_mps"], table["mode_2_per_s"], color="tab:blue")
    fit = ((10, -6.4, -8.4), (20, -3.2, -4.7), (30, -2.2, -3.4), (45, -1.4, -2.6))
    axis.plot([v for v, *_ in fit] * 2, [a for _, a, _ in fit] + [b for *_, b in fit], "ko", ms=4,
              label="fit to a log of the original")
    axis.set(xlabel="speed [m/s]", ylabel="mode [1/s]")
    axis.legend(fontsize=7)
    save(figure, f"{target}/plant_udacity_modes.svg")


def tires(source, target):
    table = read(f"{source}/tires.csv")
    figure, axis = plt.subplots(figsize=(5.5, 3.6))
    for column, label in (("physx_forward", "udacity, forward"), ("physx_sideways", "udacity, sideways"),
                          ("road_front", "road-car, front"), ("road_rear", "road-car, rear")):
        axis.plot(table["slip"], table[column], label=label)
    axis.set(xlabel="slip [– or rad]", ylabel="force / load")
    axis.legend(fontsize=7)
    save(figure, f"{target}/plant_tires.svg")


def envelope(source, target):
    table = read(f"{source}/road_car_envelope.csv")
    figure, axis = plt.subplots(figsize=(4.6, 3.8))
    axis.plot(table["ay_mps2"], table["ax_mps2"], "o-", ms=3)
    axis.set(xlabel="largest lateral acceleration [m/s²]", ylabel="longitudinal acceleration there [m/s²]", xlim=(0, 12))
    axis.axhline(0, color="0.7", lw=0.6)
    save(figure, f"{target}/plant_road_car_envelope.svg")


def main():
    for draw in (longitudinal, yaw_steps, modes, tires, envelope):
        draw(options.source, options.target)


if __name__ == "__main__":
    main()
