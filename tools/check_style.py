#!/usr/bin/env python3
"""Counts what the house style avoids, and fails when a count is above its limit.

Usage: check_style.py [--root FOLDER] [--limits FILE] [--quiet] [--update]

Reads the files that git tracks and prints file:line for each finding. Exit code 1 means that a count is above its
limit in tools/style_limits.json. --update lowers the limits to the counts and never raises them.
"""
import argparse
import io
import json
import os
import re
import subprocess
import sys
import tokenize

WORDS = 35
ARGUMENTS = 12
FUNCTION_LINES = 60
COLUMNS = 120
KINDS = {
    "openings": "comment blocks with a banned opening",
    "sentences": f"sentences over {WORDS} words",
    "arguments": f"kernels over {ARGUMENTS} arguments",
    "functions": f"functions over {FUNCTION_LINES} lines",
    "lines": f"lines over {COLUMNS} columns",
}
BANNED = re.compile(r"(of|what|whether|those|that|where|as|how|the same|likewise"
                    r"|so (do|does|did|is|are|was|were|has|have|can|will))\b", re.IGNORECASE)
ABBREVIATION = re.compile(r"\b(e\.g|i\.e|cf|vs|et al|etc|Fig|Sec)\.(?=\s)")
C_TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"([^(\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\b\d[\w\']*'
                     r"|'(?:\\.|[^'\\\n])*'", re.DOTALL)
SHELL_TOKEN = re.compile(r'(?<!\S)#[^\n]*|"(?:\\.|[^"\\])*"|(?<!\\)\'[^\']*\'', re.DOTALL)
CMAKE_TOKEN = re.compile(r'#\[(=*)\[.*?\]\1\]|#[^\n]*|\[(=*)\[.*?\]\2\]|"(?:\\.|[^"\\])*"', re.DOTALL)


def blank(text):
    """Returns spaces and line ends in the shape of the text."""
    return re.sub(r"[^\n]", " ", text)


def split_comments(text, token):
    """Returns the comments as (offset, text), and the code with comments and strings blanked."""
    comments = []

    def replace(match):
        found = match.group()
        if found.startswith(("//", "/*", "#")):
            comments.append((match.start(), found))
        return found if found[0].isdigit() else blank(found)
    return comments, token.sub(replace, text)


def python_comments(text):
    """Returns the comments and docstrings of a Python file as (offset, text)."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    comments, fresh = [], True
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        at = starts[token.start[0] - 1] + token.start[1]
        if token.type == tokenize.COMMENT:
            comments.append((at, token.string))
        elif token.type == tokenize.STRING and fresh:
            comments.append((at, re.sub(r'^"""|"""$', "", token.string)))
        if token.type not in (tokenize.COMMENT, tokenize.NL):
            fresh = token.type in (tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
    return comments


def comment_blocks(text, comments):
    """Joins comments on consecutive lines of their own into blocks: lists of (line, text) per line."""
    blocks, last = [], None
    for at, comment in comments:
        if comment.startswith("#!"):
            continue
        line = text.count("\n", 0, at) + 1
        alone = not text[text.rfind("\n", 0, at) + 1:at].strip(' "')
        lines = [re.sub(r"^\s*(///?|/\*+|\*(?!\w)|#)?<?|\*/\s*$", "", part) for part in comment.split("\n")]
        rows = list(enumerate(lines, line))
        if alone and last == line - 1:
            blocks[-1].extend(rows)
        else:
            blocks.append(rows)
        last = line + len(lines) - 1 if alone else None
    return blocks


def paragraphs(rows, markdown=False):
    """Yields (line, text) for each paragraph, list item and table cell; skips fenced code."""
    first, words, fenced = 0, [], False
    for line, text in rows + [(0, "")]:
        text = text.strip()
        fence = text.startswith("```")
        table = markdown and text.startswith("|")
        starts = not text or fence or table or re.match(r"([-*#>]|\d+\.|Usage:) ?", text)
        if starts and words:
            yield first, " ".join(words)
            words = []
        fenced ^= fence
        if fenced or fence or not text:
            continue
        if table:
            for cell in text.split("|"):
                yield line, cell
            continue
        first = first if words else line
        words.append(text)


def long_sentences(rows, markdown=False):
    """Yields (line of the paragraph, words) for each sentence that is too long."""
    for line, text in paragraphs(rows, markdown):
        for sentence in re.split(r"(?<=[.!?])[)\"*]*\s+", ABBREVIATION.sub(r"\1", text)):
            words = len(re.findall(r"\S*[^\W\d_]\S*|\d\S*", sentence))
            if words > WORDS:
                yield line, words


def functions(code):
    """Yields (first line, lines) of each function body that is not inside of another."""
    code = re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", lambda match: blank(match.group()), code, flags=re.MULTILINE)
    depth, inside, first, head = 0, None, 0, 0
    for match in re.finditer(r"[{};]", code):
        mark, at = match.group(), match.start()
        if mark == "{":
            text = code[head:at]
            flat = re.sub(r"\([^()]*\)", "", re.sub(r"\([^()]*\)", "", text))
            if inside is None and ")" in text and "=" not in flat.replace("operator", "") and \
                    not re.match(r"\s*(namespace|enum|extern\s*$)", text):
                inside, first = depth, head + len(text) - len(text.lstrip())
            depth += 1
        elif mark == "}":
            depth = max(0, depth - 1)
            if inside == depth:
                yield code.count("\n", 0, first) + 1, code.count("\n", first, at) + 1
                inside = None
        head = at + 1


def macro_bodies(code):
    """Returns the macros of a file by name: parameters and body."""
    found = {}
    define = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)(\([^)]*\))?((?:[^\n]*\\\n)*[^\n]*)", re.MULTILINE)
    for name, parameters, body in define.findall(code):
        found.setdefault(name, []).append(([p.strip() for p in parameters.strip("()").split(",") if p.strip()],
                                           body.replace("\\\n", " ")))
    return found


def closing(text, at):
    """Returns the position after the bracket that closes the one at `at`."""
    depth = 0
    for match in re.compile(r"[()]").finditer(text, at):
        depth += 1 if match.group() == "(" else -1
        if depth == 0:
            return match.end()
    return len(text)


def top_level_parts(text):
    """Splits at commas outside of brackets."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part for part in parts if part.strip()]


def expand(text, macros, depth=0):
    """Expands macros; of several definitions takes the one with most parts."""
    match = next((m for m in re.finditer(r"\w+", text) if m.group() in macros), None) if depth < 40 else None
    if not match:
        return text
    end, values = match.end(), []
    opening = re.compile(r"\s*\(").match(text, end)
    definitions = macros[match.group()]
    if opening and any(parameters for parameters, _ in definitions):
        end = closing(text, opening.start())
        values = top_level_parts(text[opening.end():end - 1])
    results = []
    for parameters, body in definitions:
        for parameter, value in zip(parameters, values):
            body = re.sub(rf"(##)?\b{parameter}\b(##)?", lambda _: value.strip(), body)
        results.append(body)
    best = max(results, key=lambda body: len(top_level_parts(body)))
    return text[:match.start()] + expand(best, macros, depth + 1) + expand(text[end:], macros, depth + 1)


def kernel_arguments(code, macros):
    """Yields (line, name, arguments) of each kernel."""
    head = re.compile(r"\b(?:__)?kernel\b(?:\s*__attribute__\s*\(\(.*?\)\)\s*\)?)?\s*void\s+(\w+)\s*(?=\()")
    for match in head.finditer(code):
        inner = code[match.end() + 1:closing(code, match.end()) - 1]
        yield code.count("\n", 0, match.start()) + 1, match.group(1), len(top_level_parts(expand(inner, macros)))


def tracked_files(root):
    command = ["git", "-c", "safe.directory=*", "-C", root, "ls-files", "-z"]
    names = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout.decode().split("\0")
    wanted = (".h", ".cpp", ".cl", ".py", ".sh", ".cmake", ".md", "CMakeLists.txt")
    return [name for name in names if name.endswith(wanted) and os.path.isfile(os.path.join(root, name))]


def check(files):
    """Returns the findings as (kind, file, line, text), and the number of comment blocks. files: texts by name."""
    findings, blocks, kernels, macros = [], 0, [], {}
    for name, text in files.items():
        def add(kind, line, what):
            findings.append((kind, name, line, what))
        if name.endswith(".md"):
            for line, words in long_sentences(list(enumerate(text.split("\n"), 1)), markdown=True):
                add("sentences", line, f"{words} words")
            continue
        for line, row in enumerate(text.split("\n"), 1):
            if len(row) > COLUMNS:
                add("lines", line, f"{len(row)} columns")
        if name.endswith(".py"):
            comments = python_comments(text)
        elif name.endswith(".sh"):
            comments, _ = split_comments(text, SHELL_TOKEN)
        elif name.endswith((".cmake", ".txt")):
            comments, _ = split_comments(text, CMAKE_TOKEN)
        else:
            comments, code = split_comments(text, C_TOKEN)
            for line, length in functions(code):
                if length > FUNCTION_LINES:
                    add("functions", line, f"{length} lines")
            if name.endswith(".cl"):
                kernels.append((name, code))
            if name.startswith(("kernels/", "study/kernels/")):
                for macro, definitions in macro_bodies(code).items():
                    macros.setdefault(macro, []).extend(definitions)
        for rows in comment_blocks(text, comments):
            blocks += 1
            opening = " ".join(row.strip() for _, row in rows).strip()
            if BANNED.match(opening):
                add("openings", rows[0][0], opening[:60])
            for line, words in long_sentences(rows):
                add("sentences", line, f"{words} words")
    for name, code in kernels:
        for line, kernel, count in kernel_arguments(code, macros):
            if count > ARGUMENTS:
                findings.append(("arguments", name, line, f"{kernel} has {count} arguments"))
    return findings, blocks


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", default=os.path.dirname(here), help="the checkout to read")
    parser.add_argument("--limits", default=os.path.join(here, "style_limits.json"), help="one number for each kind")
    parser.add_argument("--quiet", action="store_true", help="print the summary alone")
    parser.add_argument("--update", action="store_true", help="lower the limits to the counts")
    options = parser.parse_args()
    files = {}
    for name in tracked_files(options.root):
        with open(os.path.join(options.root, name), encoding="utf-8") as file:
            files[name] = file.read()
    findings, blocks = check(files)
    with open(options.limits, encoding="utf-8") as file:
        limits = json.load(file)
    if not options.quiet:
        for kind, name, line, what in sorted(findings):
            print(f"{name}:{line}: {kind}: {what}")
    failed = False
    for kind, meaning in KINDS.items():
        count = sum(finding[0] == kind for finding in findings)
        over = count > limits.get(kind, 0)
        failed |= over
        share = f", {100 * count / max(1, blocks):.1f} % of {blocks} comment blocks" if kind == "openings" else ""
        print(f"{count} {meaning} (limit {limits.get(kind, 0)}){share}{': too many' if over else ''}")
        limits[kind] = min(count, limits.get(kind, 0))
    if options.update:
        with open(options.limits, "w", encoding="utf-8") as file:
            file.write(json.dumps(limits, indent=2) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
