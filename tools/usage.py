# SPDX-License-Identifier: MIT
"""What a program of this folder is for, when it is asked."""
import sys


def print_if_asked(text):
    """Prints `text`, the program's docstring, and ends it, where its first argument is --help or -h."""
    if sys.argv[1:2] in (["--help"], ["-h"]):
        print(text.strip())
        sys.exit(0)
