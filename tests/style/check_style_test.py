"""The style checker counts what it should, and its limits only fall.

Usage: check_style_test.py FOLDER_OF_CHECK_STYLE
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

FOLDER = sys.argv.pop() if len(sys.argv) > 1 and os.path.isdir(sys.argv[-1]) else os.path.join(
    os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools")
sys.path.insert(0, FOLDER)
import check_style

LONG = "Returns " + "one " * 25 + "or\n// " + "two " * 10 + "at last."


def found(**files):
    """Returns the findings as (kind, line), the files given as name_extension."""
    findings, _ = check_style.check({name.replace("__", "/").replace("_", "."): text for name, text in files.items()})
    return [(kind, line) for kind, _, line, _ in findings]


class Findings(unittest.TestCase):
    def test_an_opening_counts_once_per_block(self):
        self.assertEqual(found(a_cpp="int a;\n// Of all pairs\n// that are near.\nint b;  // how many\n"),
                         [("openings", 2), ("openings", 4)])

    def test_the_second_line_of_a_block_may_start_with_any_word(self):
        self.assertEqual(found(a_cpp="// Returns the pairs\n// of a and b.\nconst char* s = \"// What is this\";\n"),
                         [])

    def test_openings_of_scripts_and_docstrings_count(self):
        self.assertEqual(found(a_sh="#!/bin/sh\necho \"# What\" ${#x}  # Where it is\n", b_cmake="# Those of CMake.\n",
                               c_py='def f():\n    """What it does."""\n    return "What"\n'),
                         [("openings", 2), ("openings", 1), ("openings", 2)])

    def test_a_long_sentence_counts_in_comments_and_markdown(self):
        self.assertEqual(found(a_h=f"// {LONG}\n", b_md=f"# Title\n\n{LONG}\n\n```\n{LONG}\n```\n"),
                         [("sentences", 1), ("sentences", 3)])

    def test_sentences_and_items_are_apart(self):
        half = "word " * 20
        self.assertEqual(found(a_md=f"Ends here {half}. Starts here {half}.\n- {half}\n- {half}\n| {half} | {half} |\n"),
                         [])

    def test_arguments_count_with_macros_expanded(self):
        macros = "#define TWO int a, int b\n#define SIX(x) TWO, TWO, \\\n    TWO\n"
        kernel = "__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void f(SIX(1), SIX(2){})\n{{\n}}\n"
        self.assertEqual(found(kernels__a_h=macros, kernels__b_cl=kernel.format("")), [])
        self.assertEqual(found(kernels__a_h=macros, kernels__b_cl=kernel.format(", int c")), [("arguments", 1)])

    def test_long_functions_count_and_long_classes_do_not(self):
        body = "    if (a) { b(); }\n" * 58
        self.assertEqual(found(a_cpp=f"namespace n\n{{\nint f(int a)\n{{\n{body}}}\n}}\n"), [("functions", 3)])
        self.assertEqual(found(a_cpp="class C\n{\n" + "    int f() { return 1; }\n" * 80 + "};\n"), [])

    def test_long_lines_count(self):
        self.assertEqual(found(a_cpp="\n" + "x" * 121 + "\n" + "y" * 120 + "\n"), [("lines", 2)])


class Limits(unittest.TestCase):
    def run_checker(self, *options):
        return subprocess.run([sys.executable, os.path.join(FOLDER, "check_style.py"), "--root", self.root.name,
                               "--limits", self.limits, *options], stdout=subprocess.PIPE, universal_newlines=True)

    def setUp(self):
        self.root = tempfile.TemporaryDirectory()
        self.addCleanup(self.root.cleanup)
        self.limits = os.path.join(self.root.name, "limits.json")
        with open(os.path.join(self.root.name, "a.cpp"), "w") as file:
            file.write("// What this is.\n")
        for command in (["init", "-q"], ["add", "a.cpp"]):
            subprocess.run(["git", "-C", self.root.name, *command], check=True)

    def write_limit(self, number):
        with open(self.limits, "w") as file:
            json.dump({"openings": number}, file)

    def limit(self):
        with open(self.limits) as file:
            return json.load(file)["openings"]

    def test_a_count_above_its_limit_fails_and_update_keeps_the_limit(self):
        self.write_limit(0)
        result = self.run_checker("--update")
        self.assertEqual(result.returncode, 1)
        self.assertIn("a.cpp:1: openings: What this is.", result.stdout)
        self.assertEqual(self.limit(), 0)

    def test_update_lowers_a_limit(self):
        self.write_limit(5)
        self.assertEqual(self.run_checker().returncode, 0)
        self.assertEqual(self.limit(), 5)
        self.assertEqual(self.run_checker("--update").returncode, 0)
        self.assertEqual(self.limit(), 1)


if __name__ == "__main__":
    unittest.main()
