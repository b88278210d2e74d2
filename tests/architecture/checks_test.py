#!/usr/bin/env python3
"""Plants one violation after the other in a small tree and sees the checks notice each, and nothing in the clean tree."""
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import check_header_tests  # noqa: E402
import check_layers  # noqa: E402
import check_sources  # noqa: E402

SPDX = "// SPDX-License-Identifier: MIT\n"
CLEAN = {
    "src/chicane/base/math.hpp": SPDX + "#pragma once\n#include <cmath>\n",
    "src/chicane/base/CMakeLists.txt": "chicane_module(base)\n",
    "src/chicane/solver/solve.hpp": SPDX + '#pragma once\n#include <tl/expected.hpp>\n#include "chicane/base/math.hpp"\n',
    "src/chicane/solver/solve.cpp": SPDX + '#include "chicane/solver/solve.hpp"\n// It knows no car.\n',
    "src/chicane/solver/CMakeLists.txt": "chicane_module(solver)\n",
    "apps/chicane/main.cpp": SPDX + '#include "chicane/solver/solve.hpp"\nint main() { std::puts("car"); }\n',
    "apps/chicane/CMakeLists.txt": "add_library(chicane_cli STATIC main.cpp)\n",
    "bench/CMakeLists.txt": "add_executable(bench main.cpp)\ntarget_link_libraries(bench PRIVATE chicane_solver)\n",
    "bench/main.cpp": SPDX + '#include "problems/hard.hpp"\n#include "chicane/solver/solve.hpp"\n',
    "bench/problems/hard.hpp": SPDX + "#pragma once\n",
    "docs/notation.md": "| `old_name` | `new_name` | C++ |\n| `old_key` | a state | docs |\n| `riddle` | a noun | program text |\n",
    "tests/solver/solve_test.cpp": SPDX + '#include "problems/hard.hpp"\n',
    "tests/solver/CMakeLists.txt": "chicane_test(solver PRIVATE chicane_cli)\n",
}


class Checks(unittest.TestCase):
    def violations(self, check, files=None):
        """What `check` says about the clean tree after changes `files` {path: text appended, or (text,) instead}."""
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            tree = dict(CLEAN, **{"tools/layers.txt": (ROOT / "tools/layers.txt").read_text(encoding="utf-8")})
            for path, text in (files or {}).items():
                tree[path] = text[0] if isinstance(text, tuple) else tree.get(path, SPDX) + text
            for path, text in tree.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text, encoding="utf-8")
            for name in ("examples", "bench"):
                (root / name).mkdir(exist_ok=True)
            return list(check(root))

    def expect(self, check, path, text, reason):
        found = self.violations(check, files={path: text})
        self.assertEqual(len(found), 1, found)
        self.assertIn(reason, found[0])
        self.assertRegex(found[0], r"^[\w/.]+:\d+: ")

    def test_clean_tree_has_no_violation(self):
        self.assertEqual(self.violations(check_layers.check), [])
        self.assertEqual(self.violations(check_sources.check), [])

    def test_layers(self):
        for path, text, reason in (
            ("src/chicane/base/math.hpp", '#include "chicane/solver/solve.hpp"\n', "base must not include solver/solve.hpp"),
            ("src/chicane/solver/solve.cpp", '#include "chicane/net/server.hpp"\n', "solver must not include net/server.hpp"),
            ("src/chicane/survey/image.hpp", '#include "chicane/model/state.hpp"\n', "survey must not include model/state.hpp"),
            ("src/chicane/controller/mpc.hpp", '#include "chicane/safety/gate.hpp"\n', "must not include safety/gate.hpp"),
            ("src/chicane/solver/solve.cpp", '#include "math.hpp"\n', 'expected "chicane/module/file.hpp"'),
            ("src/chicane/solver/solve.cpp", '#include "chicane/base/detail/jet.hpp"\n', "an implementation detail of base"),
            ("src/chicane/helpers/misc.hpp", "\n", "helpers is not in tools/layers.txt"),
            ("tools/layers.txt", ("base:\nsolver: base model\nmodel: base\napps: base solver model\nbench: solver\nexamples:\n"
                                  "tests: apps bench\nstudies:\n",), "listed above it"),
            ("src/chicane/solver/solve.cpp", '#include "problems/hard.hpp"\n', 'expected "chicane/module/file.hpp"'),
            ("apps/chicane/main.cpp", '#include "problems/hard.hpp"\n', "apps must not include problems/hard.hpp of bench"),
            ("bench/main.cpp", '#include "solver/solve_test.cpp"\n', "bench must not include solver/solve_test.cpp of tests"),
            ("bench/main.cpp", '#include "main.hpp"\n', "expected a header of bench"),
            ("examples/one.cpp", '#include "chicane/helpers/misc.hpp"\n', "examples must not include helpers/misc.hpp"),
            ("studies/tables/report.cpp", '#include "problems/hard.hpp"\n', "studies must not include problems/hard.hpp of bench"),
            ("bench/CMakeLists.txt", "target_link_libraries(bench PRIVATE chicane_cli)\n", "bench must not use chicane_cli"),
            ("apps/chicane/CMakeLists.txt", "target_sources(chicane_cli PRIVATE ${PROJECT_SOURCE_DIR}/bench/main.cpp)\n",
             "apps must not use ${PROJECT_SOURCE_DIR}/bench/main.cpp of bench"),
        ):
            with self.subTest(reason):
                self.expect(check_layers.check, path, text, reason)

    def test_sources(self):
        source = "src/chicane/solver/solve.cpp"
        for path, text, reason in (
            (source, "double a = std::sin(1.0);\n", "got std::sin(: bits differ"),
            (source, "double a = ::atan2(1.0, 2.0);\n", "bits differ"),
            (source, "std::normal_distribution<> d;\n", "not the same on every machine"),
            (source, "void f() { throw 1; }\n", "throws nothing"),
            (source, 'void f() { std::printf("x"); }\n', "only live, wire and apps print"),
            (source, "auto t = std::chrono::steady_clock::now();\n", "a Deadline"),
            (source, "run::old_name queue;\n", "got old_name, expected `new_name`"),
            (source, "double gain;  // Riddle of the gain\n", "got Riddle, expected a noun"),
            ("apps/chicane/main.cpp", 'constexpr char kMeaning[] = "the riddle";\n', "got riddle, expected a noun"),
            ("docs/solver.md", ("`old_key` bounds changes.\n",), "got old_key, expected a state"),
            (source, "std::mutex m;\n", "threads and locks"),
            (source, "int f() { static int calls = 0; return ++calls; }\n", "objects share nothing"),
            (source, "boost::asio::io_context c;\n", "sockets live in net"),
            (source, "double wheel_angle;\n", "solver knows no car"),
            (source, "Eigen::VectorXd v;\n", "fixed sizes only"),
            ("src/chicane/base/math.hpp", "#include <nlohmann/json.hpp>\n", "headers show tl/expected.hpp only"),
            ("src/chicane/base/math.hpp", (SPDX + "#include <cmath>\n",), "expected #pragma once"),
            (source, (SPDX + '#include <cmath>\n#include "chicane/solver/solve.hpp"\n',), "expected its own header"),
            ("tests/solver/solve_test.cpp", ("int x;\n",), "expected // SPDX"),
            ("tests/solver/solve_test.cpp", "\n" * 600, "expected at most 500"),
            ("web/src/main.tsx", (f"// {'ä' * 118}\n",), "got 121 characters, expected at most 120"),
        ):
            with self.subTest(text[:50]):
                self.expect(check_sources.check, path, text, reason)

    def test_header_tests(self):
        list_file = "tools/header_tests.txt"
        names = {
            "src/chicane/base/math.hpp": "double root(double x);\n",
            "src/chicane/solver/solve.hpp": "struct Answer { double x = 0.0; };\nAnswer solve();\n",
            "src/chicane/solver/detail/kernel.hpp": "void kernel();\n",  # needs no test
            "tests/base/math_test.cpp": '#include "chicane/base/math.hpp"\nauto two = root(4.0);\n',
            "tests/solver/solve_test.cpp": '#include "chicane/solver/solve.hpp"\nAnswer answer;\n',
        }
        self.assertEqual(self.violations(check_header_tests.check, files=names), [])
        new = {"src/chicane/base/angle.hpp": "double wrap(double x);\n"}
        data = {"src/chicane/base/place.hpp": "struct Place { double x = root(2.0); bool operator==(const Place&) const = default; };\n"}
        self.assertEqual(self.violations(check_header_tests.check, files=names | data), [])
        self.assertEqual(self.violations(check_header_tests.check, files=names | new | {list_file: ("# why\nbase/angle.hpp: hard\n",)}), [])
        for files, reason in (
            (new, "angle.hpp:1: no test in tests/ uses it"),
            ({"tests/base/math_test.cpp": ('#include <cmath>\nauto two = root(4.0);\n',)}, "math.hpp:1: no test in tests/ uses it"),
            ({"tests/base/math_test.cpp": ('#include "chicane/base/math.hpp"\n// root\n',)}, "math.hpp:1: no test in tests/ uses it"),
            (new | {list_file: ("base/angle.hpp:\n",)}, "expected 'MODULE/NAME.hpp: REASON'"),
            ({list_file: ("base/gone.hpp: hard\n",)}, "is gone: remove the line"),
            ({list_file: ("base/math.hpp: hard\n",)}, "needs no reason: remove the line"),
            (new | {list_file: ("base/angle.hpp: hard\nbase/angle.hpp: hard\n",)}, "is listed twice"),
        ):
            with self.subTest(reason):
                found = self.violations(check_header_tests.check, files=names | files)
                self.assertTrue(any(reason in violation for violation in found), found)
                for violation in found:
                    self.assertRegex(violation, r"^[\w/.]+:\d+: ")

    def test_comments_strings_and_other_names_are_no_violation(self):
        text = '// std::sin(x), the car, a old_name\n/* throw */ const char* s = "throw std::mutex"; int scar; char c = \'"\'; // throw\n'
        files = {"src/chicane/solver/solve.cpp": text, "web/src/main.ts": (f"// {'ä' * 117}\n",), "tests/solver/solve_test.cpp": "// a riddle\n",
                 "web/node_modules/a/b.ts": " " * 999}
        self.assertEqual(self.violations(check_sources.check, files=files), [])


if __name__ == "__main__":
    unittest.main()
