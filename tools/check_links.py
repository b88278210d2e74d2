#!/usr/bin/env python3
"""Checks that what the pages point to exists: links, anchors, and paths in `code`.

    tools/check_links.py        prints file:line: what is missing; exit code 1 when anything is
"""
import re
import sys
from pathlib import Path

import usage

LINK = re.compile(r"\]\((?P<target>[^)\s]+)\)")
CODE_PATH = re.compile(r"`(?P<path>[\w.-]+(?:/[\w.-]+)+\.(?:hpp|cpp|py|sh|md|txt|yaml|csv|cmake|ts|tsx|json|png|svg))`")
GENERATED = ("build/", "share/", "web/dist/")
IGNORED = {"build", "node_modules", ".git"}


def anchors(page):
    """The anchors of a page's headings, as GitHub and GitLab make them."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def missing(root, page):
    """Violations of one page."""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        where = f"{page.relative_to(root)}:{number}"
        for link in LINK.finditer(line):
            file, _, anchor = link["target"].partition("#")
            if re.match(r"\w+:", file):
                continue
            target = (page.parent / file).resolve() if file else page
            if not target.exists():
                yield f"{where}: {link['target']} does not exist"
            elif anchor and target.suffix == ".md" and anchor not in anchors(target):
                yield f"{where}: {link['target']} has no such heading"
        for code in CODE_PATH.finditer(line):
            path = code["path"]
            if path.startswith((".", *GENERATED)) or "NAME" in path:
                continue
            bases = [base for base in (root, root / "src/chicane", root / "docs", root / "web", page.parent)
                     if (base / path.split("/")[0]).is_dir()]  # a path into a folder of ours
            if bases and not any((base / path).exists() for base in bases):
                yield f"{where}: `{path}` does not exist"


def main():
    usage.print_if_asked(__doc__)
    root = Path(__file__).resolve().parent.parent
    pages = [p for p in sorted(root.rglob("*.md")) if not IGNORED & set(p.relative_to(root).parts)]
    violations = [violation for page in pages for violation in missing(root, page)]
    for violation in violations:
        print(violation)
    print(f"{len(violations)} dead links")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
