"""The tables of docs/job.md."""

import pathlib
import re
from dataclasses import dataclass, field


@dataclass
class Row:
    """A key as the page has it."""

    kind: str
    unit: str
    default: str
    range: str
    what: str


@dataclass
class Page:
    rows: dict[tuple[str, str], Row] = field(default_factory=dict)  # by section and key
    titles: dict[str, str] = field(default_factory=dict)  # of sections, from their own headings


def read(path: pathlib.Path) -> Page:
    page = Page()
    sections: list[str] = []
    widths: dict[str, int] = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            sections = re.findall(r"`([^`]+)`", line)
            for section in sections:
                # The heading of the fewest sections is the section's own.
                if len(sections) < widths.get(section, 1 << 30):
                    widths[section] = len(sections)
                    page.titles[section] = line.lstrip("# ").split(":")[0]
        cells = [plain(cell) for cell in line[1:].rstrip().removesuffix("|").split("|")]
        if line.startswith("| ") and len(cells) == 7 and cells[0] not in ("key", "---"):
            for section in sections:
                page.rows[section, cells[0]] = Row(*cells[1:5], what=cells[6])
    return page


def plain(cell: str) -> str:
    """Without what only a page shows: links, code, bold."""
    cell = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", cell.strip())
    return cell.replace("**", "").replace("\\", "")


def quoted_default(row: Row) -> str | None:
    """The value that the page gives as the default; None where it gives none, or only words."""
    found = re.fullmatch(r"`([^`]*)`", row.default)
    return found[1] if found else None
