"""What `zrno convert` says of a translation."""

from __future__ import annotations

from zrno.pipelines.convert import report_text


def test_the_table() -> None:
    result = {
        "notes": ["a remark"],
        "target": {
            "nodes": 1200, "elements": {"hex8": 7}, "particles": 0, "parts": {"1": "a"}, "materials": {}, "sets": {},
        },
        "approximated": [{"what": "hardening", "count": 1, "where": "material 1: a straight line"}],
        "dropped": [{"what": "contacts", "count": 12, "where": "a deck has none"}],
    }  # fmt: skip
    assert report_text(result).splitlines() == [
        "a remark",
        "translated   1200  nodes",
        "translated      7  hex8",
        "translated      1  parts",
        "approximated    1  hardening  material 1: a straight line",
        "dropped        12  contacts   a deck has none",
    ]
