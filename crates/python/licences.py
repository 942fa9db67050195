"""The licences of all that is linked into the wheel, as licences/THIRD-PARTY.txt, which goes into the wheel.

`python licences.py` is run by `.ci/python`, before the wheel is built. The release builds its wheels with the feature `gpu`, and
runs `python licences.py --features gpu`; the arguments are those of cargo. `python licences.py --archive FILE` writes those of the
archives for C instead. It fails where a package may not be used under terms like those of MIT or Apache-2.0.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
GOOD = {"MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "Zlib", "ISC", "0BSD", "CC0-1.0", "Unicode-3.0", "Unlicense"}
FILES = ("licen", "copying", "notice", "unlicense")
HEAD = """parry-continuum is licensed under MIT OR Apache-2.0. Its {} holds, compiled, the Rust packages below. Each stands with
the licence that it states. Then come the texts that the packages bring along, each once.
"""


def linked(folder, features):
    """The packages of others that end in the build of a package, on any system."""
    command = ["cargo", "metadata", "--format-version", "1", *features]
    metadata = json.loads(subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE).stdout)
    packages = {package["id"]: package for package in metadata["packages"]}
    needs = {node["id"]: node["deps"] for node in metadata["resolve"]["nodes"]}
    seen, left = set(), [metadata["resolve"]["root"]]
    while left:
        package = left.pop()
        if package not in seen:
            seen.add(package)
            # What only builds or tests is not linked, and macros have run by then.
            used = [need["pkg"] for need in needs[package] if any(kind["kind"] is None for kind in need["dep_kinds"])]
            left += [need for need in used if "proc-macro" not in packages[need]["targets"][0]["kind"]]
    found = [packages[package] for package in seen if packages[package]["source"]]
    return sorted(found, key=lambda package: (package["name"], package["version"]))


def is_good(expression):
    """Whether some choice that the expression offers is good: every part of an AND, any part of an OR."""
    choices = [re.split(r" OR |/", part.strip("() ")) for part in (expression or "").split(" AND ")]
    return all(any(choice.strip("() ").removesuffix(" WITH LLVM-exception") in GOOD for choice in part) for part in choices)


def main():
    arguments, kind, folder, file = sys.argv[1:], "wheel", HERE, HERE / "licences" / "THIRD-PARTY.txt"
    if arguments[:1] == ["--archive"]:
        arguments, kind, folder, file = arguments[2:], "library", HERE.parent / "c", Path(arguments[1])
    lines, texts = [HEAD.format(kind)], {}
    for package in linked(folder, arguments):
        name = f"{package['name']} {package['version']}"
        if not is_good(package["license"]):
            sys.exit(f"{name} is licensed under {package['license']}")
        lines.append(f"{name}: {package['license']}")
        for part in sorted(Path(package["manifest_path"]).parent.iterdir()):
            if part.is_file() and part.name.lower().startswith(FILES):
                text = "\n".join(line.rstrip() for line in part.read_text(errors="replace").strip().splitlines())
                texts.setdefault(text, []).append(name)
    for text, names in texts.items():
        lines += ["", "=" * 100, "Of " + ", ".join(names) + ":", "", text]
    file.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
