# SPDX-License-Identifier: MIT
"""`chicane import` as users start it: `import_test.py PROGRAM`."""
import json
import os
import re
import subprocess
import sys
import unittest

from program import ROOT, InFolder, run

TRACKS, MAPS = ROOT / "tests/data/tracks", ROOT / "tests/data/maps"


class Import(InFolder):
    def test_a_map_becomes_a_picture_and_a_road_that_is_driven(self):
        road, page = self.at / "bean.csv", self.at / "bean.html"
        code, printed, err = run("import", MAPS / "bean.yaml", "-o", road, "--preview", page)
        self.assertEqual(code, 0, err)
        self.assertTrue(printed.endswith(f"chicane drive --track {road} --car f1tenth\n"), printed)
        document = json.loads(re.search(r'id="chicane-report">(.*?)</script>', page.read_text())[1])
        self.assertIn("closed road", document["sections"][0]["parts"][0]["text"])
        names = [series["name"] for series in document["sections"][0]["parts"][-1]["series"] if series["values"]]
        self.assertEqual([name for name in names if name], ["free", "wall", "points of the file", "edge", "line", "start"])
        self.assertEqual(run("check", road, "--car", "f1tenth")[0], 0)
        for track in (road, MAPS / "bean.yaml"):
            code, out, err = run("drive", "--fast", "--laps", "1", "--car", "f1tenth", "--track", track)
            self.assertEqual(code, 0, err)
            self.assertIn("all tyres on the road", out)

    # Its steering lags by 0.16 s: weights and limits that took what is asked for the wheel drove it off eight maps of ten.
    def test_a_model_car_races_on_maps_with_the_settings_of_the_preset(self):
        for name in ("chicane", "long") if os.environ.get("CHICANE_SLOW_TESTS") else ("chicane",):
            with self.subTest(name):
                code, out, err = run("drive", "--fast", "--laps", "1", "--preset", "race", "--car", "f1tenth", "--track", MAPS / f"{name}.yaml",
                                     "--set", "time_limit_s=30", "--no-cache")
                self.assertEqual(code, 0, err)
                self.assertIn("1 of 1 laps, completed, all tyres on the road", out)

    def test_bags_of_other_programs_are_reported_by_file_and_by_folder(self):
        bag = ROOT / "tests/fuzz/corpus/bag/plain.db3"
        folder = self.at / "bag"
        folder.mkdir()
        (folder / "bag_0.db3").write_bytes(bag.read_bytes())
        (folder / "metadata.yaml").write_text("rosbag2_bagfile_information:\n")
        for log in (bag, folder):
            page = self.at / f"{log.name}.html"
            code, _, err = run("report", log, "-o", page)
            self.assertEqual(code, 0, err)
            self.assertIn("</html>", page.read_text())
        (folder / "bag_0.db3").unlink()
        code, out, err = run("identify", folder)
        self.assertEqual((code, out), (2, ""))
        self.assertIn("got a folder without .mcap or .db3, expected a bag of ROS 2", err)

    # rosbag2 writes MCAP or SQLite: the same run is the same page.
    def test_a_bag_shows_the_same_run_in_either_storage(self):
        recording = self.at / "run.mcap"
        code, _, err = run("drive", "--fast", "--track", "oval", "--laps", "2", "--record", recording)
        self.assertEqual(code, 0, err)
        pages = {}
        for storage in ("sqlite3", "mcap"):
            bag = self.at / storage / "bag"
            bag.parent.mkdir()
            subprocess.run([sys.executable, ROOT / "tools/make_bag.py", recording, bag, "--storage", storage], check=True, capture_output=True)
            page = self.at / f"{storage}.html"
            code, out, err = run("report", bag, "--track", "oval", "-o", page)
            self.assertEqual(code, 0, err)
            pages[storage] = page.read_text()
            self.assertRegex(out + err, r"bag: a log of another program, 36\.\d s, 9\d\d samples shown, [12] laps, no pedal")
        self.assertEqual(pages["sqlite3"], pages["mcap"])

    def test_what_is_refused_is_not_written(self):
        code, out, err = run("import", TRACKS / "no_loop.yaml", "-o", self.at / "none.csv")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("no_loop.yaml: free space: got no loop, open between (", err)
        self.assertFalse((self.at / "none.csv").exists())


if __name__ == "__main__":
    unittest.main()
