#!/usr/bin/env python3
"""Prints a plan of cars that differ by chance from what is configured (docs/measured/plants.md).

    studies/tables/draw_cars.py COUNT SEED [TRACK ...] > cars.yaml && chicane sweep cars.yaml

Three cars and the tracks, else four shipped ones, in turn, the noise of a good satellite receiver, grip 0.9 to 1.05, mass 0.95 to 1.1, up to 30 ms
of delay and 0.5 degrees of steering offset.
"""
import random
import sys

CARS, TRACKS = ("udacity", "road-car", "bmw-320i"), ("lakeside", "hairpins", "speedway", "original-lake")
count, seed = map(int, sys.argv[1:3])
TRACKS = sys.argv[3:] or TRACKS
draw = random.Random(seed)
axes = {"car": [CARS[i % 3] for i in range(count)], "track": [TRACKS[i // 3 % len(TRACKS)] for i in range(count)],
        "seed": [draw.randrange(1000, 99999) for _ in range(count)]}
for key, low, high in (("plant_options.friction_scale", 0.9, 1.05), ("plant_options.mass_scale", 0.95, 1.1),
                       ("sensor.latency_ms", 0, 30), ("fault", -0.5, 0.5)):
    axes[key] = [("steering_offset@0+1000*" if key == "fault" else "") + f"{draw.uniform(low, high):.3f}" for _ in range(count)]
print(f"name: cars-{seed}\nsettings: {{laps: 4, time_limit_s: 600, sensor.position_noise_m: 0.05, sensor.heading_noise_deg: 0.3, "
      "sensor.speed_noise_mps: 0.1}\naxes:\n  - preset: [race, default]")
print("  - " + "\n    ".join(f"{key}: [{', '.join(map(str, values))}]" for key, values in axes.items()))
print("keep: [completed, end_reason, off_track_events, lap_times_s, lap_time_s, min_edge_distance_m, guard_reasons]")
