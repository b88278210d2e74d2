#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What `chicane bench --json` says of the solvers, as CSV: machine in comments, a line for each family and horizon."""
import csv
import json
import sys

report = json.load(sys.stdin)
for key in ("processor", "compiler", "flags", "commit", "date", "references", "load_before", "load_after", "growth_exponent"):
    print(f"# {key}: {report[key]}")
print(f"# form: {report['form']}")
for guard in ("step_with_guard", "step_without_guard"):
    for key in ("cpu_time_us", "wall_time_us", "solve_time_us"):
        print(f"# {guard} {key}:", ", ".join(f"{share} {time:.1f}" for share, time in report[guard][key].items()))
rows = report["solves"]
columns = list(dict.fromkeys(key for row in rows for key in row))
table = csv.DictWriter(sys.stdout, columns, lineterminator="\n")
table.writeheader()
for row in rows:
    table.writerow({key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()})
