from html.parser import HTMLParser

from calm.report.html import fragment
from calm.report.sheet import result_part


class Cells(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.rows = [], []

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)
        if tag == "tr":
            self.rows.append([])

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "tr" in self.open and data.strip():
            self.rows[-1].append(data)


def test_table_is_well_formed_and_complete(result):
    parser = Cells()
    parser.feed(fragment(result_part(result)))
    assert parser.open == []
    assert len(parser.rows) == 1 + 8 + 2 + 3  # heads, pieces, clamps; top, line and anchor
    assert parser.rows[1] == [
        "top float", "1.25", "113.2", "986.8", "8.2", "61.0", "3.1", "7003", "17.1"
    ]  # fmt: skip


def test_everything_is_escaped(make_result):
    result = make_result(name="<script>", warnings=("a < b",))
    result.components[0].label = "<b>&"
    html = fragment(result_part(result))
    assert "<script>" not in html
    assert "&lt;b&gt;&amp;" in html
    assert "a &lt; b" in html
