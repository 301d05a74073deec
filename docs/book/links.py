"""Checks the links of the built book: to a page, to a file beside it, or to a file of the repository.

A link to a file of the repository that is no page leads nowhere in the built book; it becomes plain
text there.

    python3 links.py BOOK DOCS
"""

import re
import sys
from pathlib import Path

book, docs = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
dead = []
for page in sorted(book.rglob("*.html")):
    text = page.read_text(encoding="utf-8")

    def checked(match):
        target = match.group(1).split("#")[0]
        if not target or "://" in target or (page.parent / target).exists():
            return match.group(0)
        # where the link would lead in the repository
        source = docs / page.relative_to(book).parent / target
        if source.exists() or source.with_suffix(".md").exists():
            return f"<code>{match.group(2)}</code>" if "<code>" not in match.group(2) else match.group(2)
        dead.append(f"{page.relative_to(book)}: {match.group(1)}")
        return match.group(0)

    # only links of the text: those of the page's own frame are mdbook's
    begin, end = text.find("<main>"), text.find("</main>")
    if begin < 0:
        continue
    body = re.sub(r'<a href="([^"]*)">(.*?)</a>', checked, text[begin:end])
    page.write_text(text[:begin] + body + text[end:], encoding="utf-8")
print(f"{len(list(book.rglob('*.html')))} pages")
if dead:
    sys.exit("links that lead nowhere:\n" + "\n".join(dead))
