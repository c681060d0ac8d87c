"""The page: one file that needs nothing else, with every formula set and all code ready to be copied."""

from __future__ import annotations

import contextlib
import html
import io
import json
import os
import re
import shutil
import subprocess
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest

from geocosserat.referee.mathml import mathml, typeset
from geocosserat.referee.page import MEANING, page
from geocosserat.referee.report import VERDICTS, Report, review
from geocosserat.referee.statement import Section
from tests.referee import paper

TITLE = "Rods & <squares>"


@pytest.fixture(scope="module")
def report() -> Report:
    return review(paper.SECTIONS)


@pytest.fixture(scope="module")
def text(report: Report) -> str:
    return page(report, TITLE, "A. Author")


class _Reader(HTMLParser):
    """Elements with their attributes, and whether each that opens is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.found: list[tuple[str, dict[str, str]]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open.append(tag)
        self.found.append((tag, {name: value or "" for name, value in attrs}))

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, {name: value or "" for name, value in attrs}))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def elements(text: str) -> list[tuple[str, dict[str, str]]]:
    reader = _Reader()
    reader.feed(text)
    reader.close()
    assert not reader.open
    return reader.found


def test_the_page_is_well_formed(text: str) -> None:
    """As HTML and as XML; what was said with & and < is text."""
    ElementTree.fromstring(text)
    found = elements(text)
    assert Counter(tag for tag, _ in found)["article"] == 4
    assert f"<h1>{html.escape(TITLE)}</h1>" in text
    assert "<for small y>" not in text
    assert "&lt;for small y&gt;" in text


def test_nothing_is_loaded_from_anywhere(text: str) -> None:
    """No address of the net, no file beside it; links stay on the page and lead somewhere."""
    assert "http" not in text
    assert "@import" not in text
    assert "url(" not in text
    ids = [attrs["id"] for _, attrs in elements(text) if "id" in attrs]
    assert len(ids) == len(set(ids))
    for _, attrs in elements(text):
        assert not {"src", "srcset", "data", "action", "background"} & set(attrs)
        assert "href" not in attrs or attrs["href"].removeprefix("#") in ids


def test_each_statement_has_its_two_forms_its_verdict_in_words_and_how(text: str, report: Report) -> None:
    """In the order of the paper; the verdict is a word, not a colour alone."""
    articles = re.findall(r"<article.*?</article>", text, re.DOTALL)
    assert len(articles) == len(report.findings)
    for article, f in zip(articles, report.findings, strict=True):
        assert article.count("<math") >= 2
        assert f'<span class="verdict {f.verdict}">{f.verdict}</span>' in article
        assert f">{html.escape(f.statement.name)}</a>" in article
        assert f.how in html.unescape(article)
        assert ("holds if" in article) == (f.verdict == "conditional")
        assert ("corrected, as derived" in article) == (f.verdict == "misprint")


def test_what_is_named_is_linked(text: str) -> None:
    """In remarks and in what suffers; what the page does not hold is not."""
    assert re.search(r'see <a href="#s1-1a">\(1a\)</a> &amp; <span class="piece"><math', text)
    assert '<dt>affects</dt><dd><a href="#s1-1a">(1)</a></dd>' in text
    assert "<dt>affects</dt><dd>(2), (9)</dd>" in text


def test_every_verdict_has_a_filter_a_meaning_a_colour_and_a_column(text: str) -> None:
    """Also those that no statement has."""
    assert list(MEANING) == list(VERDICTS)
    buttons = [attrs.get("data-verdict") for tag, attrs in elements(text) if tag == "button"]
    assert [name for name in buttons if name] == list(VERDICTS)
    for verdict in VERDICTS:
        assert MEANING[verdict] in text
        assert text.count(f"--{verdict}: #") == 2  # in the light and in the dark
        assert f'<th scope="col" class="{verdict}">{verdict}</th>' in text


def test_the_summary_counts_and_links(text: str) -> None:
    """A number leads to the statements it counts."""
    assert '<a href="#section-1">Kinematics &amp; signs</a>' in text
    assert '<td><a href="#section-2" data-show="conditional">1</a></td>' in text


def test_the_code_on_the_page_runs_as_it_stands(text: str, report: Report) -> None:
    """Copied, it prints verdict and how."""
    blocks = re.findall(r"<pre><code>(.*?)</code></pre>", text, re.DOTALL)
    assert len(blocks) == len(report.findings)
    for block, finding in zip(blocks, report.findings, strict=True):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(html.unescape(block), "<copied>", "exec"), {"__name__": "copied"})
        assert out.getvalue().strip() == repr((finding.verdict, finding.how))


@pytest.mark.parametrize(
    ("latex", "found"),
    [
        (r"\nosuch{x}", r"the unknown command \\nosuch"),
        (r"\frac{a", "braces that do not pair"),
        (r"a}", "braces that do not pair"),
        (r"\frac{a}", "1 parts of mfrac"),
        (r"\left(\frac ab\right", "StopIteration"),
        (r"a^", "MissingSuperScriptOrSubscriptError"),
        (r"a_b_c", "DoubleSubscriptsError"),
        (r"a & b", "ParseError"),
        (r"\begin{pmatrix}a", "MissingEndError"),
        ("", "nothing"),
        (r"\quad", "nothing"),
    ],
)
def test_a_formula_that_cannot_be_set_is_refused(latex: str, found: str) -> None:
    """Not shown as it stands, nor half of it; the statement is named."""
    with pytest.raises(ValueError, match=f"expected LaTeX that can be shown as MathML, found {found}"):
        typeset(latex)
    section = Section("one")
    section.states("(7)", "nonsense", latex)(paper.square)
    with pytest.raises(ValueError, match="expected LaTeX") as raised:
        page(review([section]), "one")
    assert raised.value.__notes__ == ["in (7)"]


def test_a_dollar_alone_is_refused() -> None:
    """Formulas in a remark stand between two."""
    section = Section("one")
    section.states("(7)", "a price", "x=x", remark="for 5 $")(paper.square)
    with pytest.raises(ValueError, match=r"expected dollar signs in pairs, found 1 in 'for 5 \$'"):
        page(review([section]), "one")


@pytest.mark.parametrize(
    ("latex", "wanted"),
    [
        (r"\boldsymbol{\Pi}", "<mi>\U0001d72b</mi>"),  # a letter of its own: browsers know no bold style of letters
        (r"\boldsymbol{r}", "<mi>\U0001d493</mi>"),
        (r"\mathfrak{g}", "<mi>\U0001d524</mi>"),
        (r"\mathcal{D}", "<mi>\U0001d49f</mi>"),
        (r"\mathcal{L}", "<mi>\u2112</mi>"),
        (r"\mathbb{R}", "<mi>\u211d</mi>"),
        (r"\mathrm{ad}_E", "<mi>ad</mi>"),
        (r"\dot x", '<mover accent="true">'),
        (r"\underline{\underline{K}}", '<mrow class="under"><mrow><mrow class="under">'),
        (r"x'", '<mi>x</mi><mo lspace="0" rspace="0">\u2032</mo>'),
        (r"x_i'", "<msub><mrow><mi>x</mi>"),
        (r"a\cos\theta", '<mo lspace="0.17em" rspace="0.17em">cos</mo>'),
        (r"a=-b", '<mo form="prefix">\u2212</mo>'),
        (r"(a)-b", "<mo>\u2212</mo>"),
    ],
)
def test_formulas_are_written_as_browsers_set_them(latex: str, wanted: str) -> None:
    """Without what only some fonts or browsers can do."""
    assert wanted in mathml(latex)


def test_long_lines_may_break_where_words_or_gaps_are() -> None:
    """Not within braces, brackets of a size, or a matrix."""
    kinds = [kind for kind, _ in typeset(r"\text{six equations for }x;\quad y=z\qquad x\text{ if }y")]
    assert kinds == ["text", "math", "math", "math"]
    for whole in (r"\begin{pmatrix}a\quad b\\c&d\end{pmatrix}", r"{a\quad b}", r"\left(a\quad b\right)"):
        assert len(typeset(whole)) == 1


# in a browser


def _browser() -> str:
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
    found = next(filter(None, map(shutil.which, names)), None)
    if found is None:
        pytest.skip(f"no Chromium on the path to look at the page with (any of {', '.join(names)})")
    return found


def _tried(text: str, script: str, folder: Path) -> dict[str, object]:
    """What a script that is run at the end of the page found."""
    keep = f"document.documentElement.dataset.found = JSON.stringify((() => {{ {script} }})());"
    ending = f"<script>{keep}</script></body>"
    file = folder / "page.html"
    file.write_text(text.replace("</body>", ending))
    options = ["--headless", "--disable-gpu", "--no-first-run", f"--user-data-dir={folder / 'profile'}"]
    options += ["--no-sandbox"] if os.geteuid() == 0 else []  # which Chromium refuses to root
    command = [_browser(), *options, "--virtual-time-budget=3000", "--dump-dom", file.as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    found = re.search(r'data-found="(.*?)"', done.stdout)
    assert found, done.stderr
    fields: dict[str, object] = json.loads(html.unescape(found[1]))
    return fields


def test_filters_and_search_work_in_a_browser_from_a_file(text: str, tmp_path: Path) -> None:
    """One click leaves one kind, the next adds one, the last brings all back; words narrow it down; counts follow."""
    script = """
    const shown = () => [...document.querySelectorAll("article:not([hidden]) .name")].map(a => a.textContent);
    const click = verdict => document.querySelector(`#controls button[data-verdict=${verdict}]`).click();
    const type = words => { search.value = words; search.dispatchEvent(new Event("input")); };
    const found = { all: shown(), count: document.getElementById("shown").textContent };
    click("misprint"); found.one = shown();
    click("holds"); found.two = shown();
    click("misprint"); click("holds"); found.again = shown();
    type("SQUARE <for"); found.words = shown();
    type("nowhere"); found.none = document.getElementById("shown").textContent;
    type("");
    document.querySelector("a[data-show=conditional]").click(); found.link = shown();
    location.hash = "#s1-1a"; reveal(); found.target = shown();
    const button = document.querySelector("button.copy");
    found.copy = !button.hidden;
    found.wide = document.querySelector("math").getBoundingClientRect().width > 5;
    return found;
    """
    found = _tried(text, script, tmp_path)
    every = ["(1a)", "(1b)", "I01", paper.LONG]
    assert found == {
        "all": every, "count": "4 of 4", "one": ["(1b)"], "two": ["(1b)", "I01"], "again": every,
        "words": [paper.LONG], "none": "0 of 4", "link": [paper.LONG], "target": every, "copy": True, "wide": True,
    }  # fmt: skip


@pytest.mark.parametrize("width", [360, 1200])
def test_the_page_fits_a_phone_and_a_desk(text: str, width: int, tmp_path: Path) -> None:
    """Nothing sticks out to the side."""
    frame = f'<iframe style="width: {width}px; height: 800px" srcdoc="{html.escape(text)}"></iframe>'
    script = """
    const frame = document.querySelector("iframe");
    const measure = () => {
      const root = frame.contentDocument.documentElement;
      document.documentElement.dataset.found = JSON.stringify({ page: root.scrollWidth, window: root.clientWidth });
    };
    frame.onload = measure;
    return {};
    """
    found = _tried(f"<!DOCTYPE html><html><body>{frame}</body></html>", script, tmp_path)
    assert found["window"] in (width, width - 15)  # less a bar to scroll with
    assert found["page"] == found["window"]
