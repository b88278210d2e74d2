#!/usr/bin/env python3
"""Checks that data/layouts/plotjuggler.xml plots what is sent: fields of topics that exist, each panel shown with its share.

    tests/layouts/plotjuggler_test.py ROOT
"""
import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

NUMBER = re.compile(r"^(?:float(?:32|64)|u?int(?:8|16|32|64)|bool) (\w+)\s*(?:#.*)?$", re.MULTILINE)


def fields(root):
    """Names as PlotJuggler gives them to the numbers of each topic's own type."""
    topics = json.loads((root / "tests/protocol/fixtures/ros/topics.json").read_text())
    for each in topics:
        own = each["schema"].split("=" * 80)[0]
        for name in NUMBER.findall(own):
            yield f"{each['topic']}/{name}"


def faults(root):
    layout = ElementTree.parse(root / "data/layouts/plotjuggler.xml").getroot()
    known = set(fields(root))
    curves = list(layout.iter("curve"))
    if layout.tag != "root" or not list(layout.iter("Tab")) or len(curves) < 20:
        yield "expected a layout with tabs and curves"
    for curve in curves:
        names = [curve.get("curve_x"), curve.get("curve_y")] if curve.get("curve_x") else [curve.get("name")]
        for name in names:
            if name not in known:
                yield f"got the curve {name}, expected a number of a topic that is sent"
    for splitter in layout.iter("DockSplitter"):
        shares = [float(share) for share in splitter.get("sizes").split(";")]
        if len(splitter) != int(splitter.get("count")) or len(shares) != len(splitter) or abs(sum(shares) - 1) > 1e-3:
            yield f"got {splitter.attrib} for {len(splitter)} parts, expected as many, and shares that sum to 1"


def main():
    found = list(faults(Path(sys.argv[1]).resolve()))
    print("\n".join(found) or "data/layouts/plotjuggler.xml plots what is sent")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
