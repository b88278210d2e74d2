#!/usr/bin/env python3
"""Checks how a program was hardened, by readelf, as hardening-check of Debian's devscripts does.

    tools/check_hardening.py PROGRAM    prints what is missing; exit code 1 when anything is
"""
import re
import subprocess
import sys

import usage


def readelf(*arguments):
    return subprocess.run(["readelf", "--wide", *arguments], check=True, capture_output=True, text=True, errors="replace").stdout


def missing(program):
    """What a program lacks, one sentence each."""
    segments = readelf("--program-headers", program)
    dynamic = readelf("--dynamic", program)
    symbols = readelf("--dyn-syms", program)
    kind = re.search(r"Elf file type is (\w+)", segments)
    if not kind or kind[1] != "DYN":
        yield "position independent: got a fixed address, expected -fPIE -pie"
    if "GNU_RELRO" not in segments:
        yield "read-only relocations: got none, expected -Wl,-z,relro"
    if not re.search(r"BIND_NOW|FLAGS_1.*\bNOW\b", dynamic):
        yield "immediate binding: got lazy binding, expected -Wl,-z,now"
    stack = re.search(r"GNU_STACK\s.*", segments)
    if not stack or "RWE" in stack[0]:
        yield "stack: got an executable one, expected one that is not"
    if "__stack_chk_fail" not in symbols:
        yield "stack protector: got none, expected -fstack-protector-strong"
    if not re.search(r"__\w+_chk\b", symbols.replace("__stack_chk_fail", "")):
        yield "checked functions of the C library: got none, expected -D_FORTIFY_SOURCE=2"


if __name__ == "__main__":
    usage.print_if_asked(__doc__)
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    faults = list(missing(sys.argv[1]))
    for fault in faults:
        print(f"{sys.argv[1]}: {fault}")
    sys.exit(1 if faults else 0)
