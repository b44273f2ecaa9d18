"""Reads Markdown pages: which there are, and their headings, links and fenced blocks."""

import re
from pathlib import Path

FENCE = re.compile(r"^ *```\s*(\w*)")
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)")
PASSED_OVER = {"build", "demo", "_deps"}


def pages_of(root):
    """Returns every Markdown file of the repository, sorted."""
    return sorted(path for path in Path(root).rglob("*.md")
                  if not any(part in PASSED_OVER or part.startswith(".")
                             for part in path.relative_to(root).parts[:-1]))


def split_blocks(text):
    """Returns the lines outside of fenced blocks with their numbers, and the blocks as (language, code)."""
    prose, blocks, code = [], [], None
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if fence and code is None:
            language, code = fence[1], []
        elif fence:
            blocks.append((language, "\n".join(code) + "\n"))
            code = None
        elif code is not None:
            code.append(line)
        else:
            prose.append((number, line))
    return prose, blocks


def links_of(prose):
    """Returns (line number, target) of every link that does not stand in code."""
    return [(number, target) for number, line in prose
            for target in LINK.findall(re.sub(r"(?<!\[)`[^`]*`(?!\])", "", line))]


def anchors_of(prose):
    """Returns the anchors of all headings, as GitHub makes them."""
    anchors = set()
    for _, line in prose:
        heading = re.match(r"#{1,6} +(.*)", line)
        if not heading:
            continue
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).strip().lower()
        anchor = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
        name, count = anchor, 0
        while name in anchors:
            count += 1
            name = f"{anchor}-{count}"
        anchors.add(name)
    return anchors
