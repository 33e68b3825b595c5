"""Every Python block of the book runs, and prints what the block below it shows.

The blocks of a page are one program, run in a copy of the page's folder `NAME.in`. What a block prints stands in a block
```` ```text ```` right below it, in which `[..]` stands for characters that differ from run to run. `UPDATE=1 pytest
python/tests/test_book.py` writes what they print today into the pages: read the diff.
"""

import contextlib
import io
import os
import re
import shutil
from pathlib import Path

import pytest

BOOK = Path(__file__).parents[2] / "book" / "src"
BLOCK = re.compile(r"```python\n(.*?)```(?:\n\n```text\n(.*?)```)?", re.DOTALL)
PAGES = sorted(page.stem for page in BOOK.glob("*.md") if "```python" in page.read_text(encoding="utf-8"))


def same(printed: str, shown: str) -> bool:
    pattern = ".*?".join(re.escape(part) for part in shown.split("[..]"))
    return re.fullmatch(pattern, printed) is not None


def test_there_are_pages():
    assert PAGES


@pytest.mark.parametrize("name", PAGES)
def test_the_blocks_print_what_the_page_shows(name, tmp_path, monkeypatch):
    page = BOOK / f"{name}.md"
    if (BOOK / f"{name}.in").exists():
        shutil.copytree(BOOK / f"{name}.in", tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    text = page.read_text(encoding="utf-8")
    names: dict = {"__name__": "book"}
    wrong = []

    def run(block: re.Match) -> str:
        program, shown = block[1], block[2] or ""
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(program, page.name, "exec"), names)
        printed = out.getvalue()
        if same(printed, shown):
            return block[0]
        wrong.append(f"{program}\nprints\n{printed}\nand the page shows\n{shown}")
        return f"```python\n{program}```\n\n```text\n{printed}```"

    new = BLOCK.sub(run, text)
    if os.environ.get("UPDATE"):
        page.write_text(new, encoding="utf-8")
    else:
        assert not wrong, "\n\n".join(wrong)
