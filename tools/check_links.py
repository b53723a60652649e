"""Checks the relative links of the repository's Markdown files: check_links.py [FOLDER]

Reports each link to a missing file and each link to a missing heading. The exit code is 1 if there is one.
"""
import os
import re
import subprocess
import sys


def text_of(path):
    """Returns the file without its code blocks, in which brackets are no links."""
    with open(path, encoding="utf-8") as file:
        return re.sub(r"^```.*?^```", "", file.read(), flags=re.DOTALL | re.MULTILINE)


def anchors_of(path):
    """Returns the anchors of the file's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ +(.+?) *$", text_of(path), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def problems_of(path):
    """Yields a line for each relative link that leads nowhere."""
    for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", text_of(path))):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        file = os.path.normpath(os.path.join(os.path.dirname(path), name)) if name else path
        if not os.path.exists(file):
            yield f"{path}: {target}: no such file"
        elif anchor and file.endswith(".md") and anchor not in anchors_of(file):
            yield f"{path}: {target}: no such heading"


def documents(folder):
    """Returns the Markdown files that git knows, or those below the folder outside of a repository."""
    listed = subprocess.run(["git", "-C", folder, "ls-files", "-co", "--exclude-standard", "*.md"],
                            capture_output=True, text=True, check=False)
    if listed.returncode == 0:
        return [path for path in (os.path.join(folder, line) for line in listed.stdout.split("\n") if line)
                if os.path.exists(path)]
    found = (os.path.join(top, name) for top, _, names in os.walk(folder) for name in names)
    return [path for path in found if path.endswith(".md") and "/build/" not in path]


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
    problems = [problem for path in documents(folder) for problem in problems_of(path)]
    print("\n".join(problems) if problems else "All links lead somewhere.")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
