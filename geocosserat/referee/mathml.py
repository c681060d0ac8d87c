"""Formulas in LaTeX as MathML that browsers set by themselves; what cannot be converted raises."""

from __future__ import annotations

import re
import unicodedata
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from latex2mathml.converter import convert

CHILDREN = {
    "mfrac": 2, "mroot": 2, "msub": 2, "msup": 2, "munder": 2, "mover": 2, "msubsup": 3, "munderover": 3,
}  # fmt: skip
ACCENTS = frozenset("\u02d9\u00a8^~\u203e\u00af\u2192\u02c6\u02dc")  # dots, hat, tilde, bars, arrow
PRIMES = frozenset("\u2032\u2033\u2034")
UNDERLINE = "\u2015"
THIN = "0.17em"
INTEGRALS = frozenset("\u222b\u222c\u222e")
SIGNS, CLOSING = frozenset("+-\u2212\u00b1"), frozenset(")]}|") | PRIMES
ALPHABETS = {
    "bold": "BOLD", "italic": "ITALIC", "bold-italic": "BOLD ITALIC", "double-struck": "DOUBLE-STRUCK",
    "script": "SCRIPT", "fraktur": "FRAKTUR", "sans-serif": "SANS-SERIF", "monospace": "MONOSPACE",
}  # fmt: skip


def typeset(latex: str) -> list[tuple[str, str]]:
    """Pieces between which a line may break: ("text", words) or ("math", MathML).

    Cut where LaTeX has a quad or words, outside of all braces. Raises ValueError for LaTeX that is not understood.
    """
    found = []
    pieces = _pieces(latex)
    if not pieces:
        raise _refused(latex, "nothing")
    for piece in pieces:
        words = re.fullmatch(r"\\text\{([^{}\\$]*)\}", piece)
        found.append(("text", words[1].strip()) if words else ("math", mathml(piece)))
    return found


def mathml(latex: str) -> str:
    """One formula. Raises ValueError for LaTeX that is not understood."""
    if re.sub(r"\\[{}]", "", latex).count("{") != re.sub(r"\\[{}]", "", latex).count("}"):
        raise _refused(latex, "braces that do not pair")
    try:
        tree = ElementTree.fromstring(convert(latex).replace(' xmlns="http://www.w3.org/1998/Math/MathML"', ""))
    except Exception as error:  # the converter has a dozen of its own, and StopIteration where the formula ends early
        raise _refused(latex, f"{type(error).__name__} {error}".strip()) from error
    for node in tree.iter():
        wrong = _wrong(node)
        if wrong:
            raise _refused(latex, wrong)
    for node in list(tree.iter()):
        _mend(node)
    tree.attrib = {"displaystyle": "true"}
    return ElementTree.tostring(tree, encoding="unicode")


def _refused(latex: str, found: str) -> ValueError:
    return ValueError(f"expected LaTeX that can be shown as MathML, found {found} in {latex!r}; write it otherwise")


def _wrong(node: Element) -> str:
    """What the converter left as it stood, or left out."""
    if node.text and "\\" in node.text:
        return f"the unknown command {node.text}"
    if len(node) != CHILDREN.get(node.tag, len(node)):
        return f"{len(node)} parts of {node.tag}"
    return ""


def _mend(node: Element) -> None:
    """Browsers know letters, not styles of letters; and fonts differ in how they raise a prime or lower a line."""
    style = node.get("mathvariant")
    if node.tag in ("mi", "mn") and style in ALPHABETS and node.text:
        node.text = "".join(_styled(c, ALPHABETS[style]) for c in node.text)
        del node.attrib["mathvariant"]
    if node.tag == "mi" and node.text == ";":
        node.tag = "mo"
    if node.tag == "mo" and node.text == "\u2202":
        node.tag = "mi"
    if node.tag == "mo" and node.text in INTEGRALS:
        node.set("rspace", THIN)
    if node.tag in ("msup", "msubsup") and node[-1].text in PRIMES:
        _prime(node)
    if node.tag == "mover" and node[1].tag == "mo" and node[1].text in ACCENTS:
        node.set("accent", "true")
    if node.tag == "munder" and node[1].text == UNDERLINE:
        node.tag, node.attrib = "mrow", {"class": "under"}
        node.remove(node[1])
    if node.tag == "mrow":
        _name(node)
        _space(node)


def _prime(node: Element) -> None:
    """Beside what it belongs to: the glyph is raised already."""
    base, *low, prime = list(node)
    for child in list(node):
        node.remove(child)
    prime.tag, prime.attrib = "mo", {"lspace": "0", "rspace": "0"}
    primed = ElementTree.Element("mrow")
    primed.extend([base, prime])
    node.tag = "msub" if low else "mrow"
    node.extend([primed, *low] if low else [base, prime])


def _name(row: Element) -> None:
    """A name of several upright letters is one element."""
    letters = [child for child in row if child.tag == "mi" and child.get("mathvariant") == "normal"]
    if len(letters) == len(row) > 1:
        letters[0].text = "".join(child.text or "" for child in letters)
        del letters[0].attrib["mathvariant"]
        for child in letters[1:]:
            row.remove(child)


def _space(row: Element) -> None:
    """Around cos and the like, and after a sign, as LaTeX has it."""
    for k, child in enumerate(row):
        before = row[k - 1] if k else None
        after = row[k + 1].text if k + 1 < len(row) else None
        if child.tag == "mi" and len(child.text or "") > 1 and "mathvariant" not in child.attrib and len(row) > 1:
            child.tag = "mo"
            child.attrib = {"lspace": THIN if k else "0", "rspace": "0" if after == "(" else THIN}
        elif child.text in SIGNS and before is not None and before.tag == "mo" and before.text not in CLOSING:
            child.set("form", "prefix")


def _styled(letter: str, alphabet: str) -> str:
    """The mathematical letter, or the letter itself where Unicode has none."""
    case = re.fullmatch(r"(?:LATIN|GREEK) (CAPITAL|SMALL) LETTER (\w+)", unicodedata.name(letter, ""))
    plain = re.fullmatch(r"DIGIT (\w+)", unicodedata.name(letter, ""))
    names = [f"{case[1]} {case[2]}"] if case else [f"DIGIT {plain[1]}"] if plain else []
    for name in names:
        # the letters that were there before the rest came have shorter names
        for whole in (f"MATHEMATICAL {alphabet} {name}", f"{alphabet.replace('FRAKTUR', 'BLACK-LETTER')} {name}"):
            try:
                return unicodedata.lookup(whole)
            except KeyError:
                continue
    return letter


_TOKEN = re.compile(r"\\text\{[^{}\\$]{6,}\}|\\(?:begin|end)\{\w+\*?\}|\\[a-zA-Z]+|\\.|[{}]|[^\\{}]+", re.DOTALL)


def _pieces(latex: str) -> list[str]:
    pieces, depth = [""], 0
    for token in _TOKEN.findall(latex):
        depth += token in ("{", r"\left") or token.startswith(r"\begin{")
        depth -= token in ("}", r"\right") or token.startswith(r"\end{")
        if depth == 0 and token in (r"\quad", r"\qquad"):
            pieces.append("")
        elif depth == 0 and token.startswith(r"\text{"):
            pieces += [token, ""]
        else:
            pieces[-1] += token
    return [piece.strip() for piece in pieces if piece.strip().removesuffix("\\")]
