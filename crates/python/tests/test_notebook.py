"""The notebook of the examples shows what it computes. The README runs in a notebook, then children and the button that stops a cell.

Skipped without what a notebook needs, unless REQUIRE_EXAMPLES is set. With WRITE_NOTEBOOK the outputs are written, not compared.
"""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path
from typing import Any

import pytest

FIRST_HOUR = Path(__file__).parent.parent / "examples" / "first_hour.ipynb"
README = (Path(__file__).parent.parent / "README.md").read_text()

CHILDREN = """
import multiprocessing
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

expected = mesh.distance(robots, 0.8)
for method in {"fork", "spawn"} & set(multiprocessing.get_all_start_methods()):
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(method)) as children:
        for found in children.map(mesh.distance, [robots] * 4, [0.8] * 4):
            assert np.array_equal(found, expected)
with ThreadPoolExecutor(4) as threads:
    for found in threads.map(lambda _: mesh.distance(robots, 0.8), range(8)):
        assert np.array_equal(found, expected)
"""

# What the button does on Linux and macOS: a signal to the kernel, in the middle of a batch that takes far longer.
STOP = """
import os, signal, threading, time

many = np.tile(robots, (300, 1, 1))
begin = time.monotonic()
mesh.per_link(many[:3000], 0.8)
seconds = time.monotonic() - begin
threading.Timer(seconds, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
begin = time.monotonic()
try:
    mesh.per_link(many, 0.8)
except KeyboardInterrupt:
    assert time.monotonic() - begin < 5 * seconds + 1
else:
    raise AssertionError("the batch went on")
assert np.array_equal(mesh.distance(robots, 0.8), expected)
"""


def execute(book: Any, folder: Path) -> None:
    """Runs all cells in a folder, by the interpreter that runs this, whatever kernels are installed."""
    import nbclient

    resources = {"metadata": {"path": str(folder)}}
    options = {"timeout": 300, "kernel_name": "python3", "record_timing": False}
    nbclient.NotebookClient(book, resources=resources, **options).execute()


def needs(*packages: str) -> None:
    if not os.environ.get("REQUIRE_EXAMPLES"):
        for package in packages:
            pytest.importorskip(package)


def outputs(cell: Any) -> list[str]:
    """What a cell shows, less the pixels of its pictures."""
    texts = []
    for output in cell.outputs:
        if output.output_type == "stream":
            texts.append(f"{output.name}: {output.text}")
        elif "image/png" in output.get("data", {}):
            texts.append("picture")
        else:
            texts.append("".join(output.get("data", {"text/plain": "error"})["text/plain"]))
    return texts


@pytest.mark.filterwarnings("ignore")
def test_first_hour() -> None:
    needs("nbclient", "ipykernel", "matplotlib", "nibabel")
    import nbformat

    stored, book = (nbformat.read(FIRST_HOUR, as_version=4) for _ in range(2))
    codes = [k for k, cell in enumerate(stored.cells) if cell.cell_type == "code"]
    assert [stored.cells[k].execution_count for k in codes] == list(range(1, len(codes) + 1))
    for k in codes:
        book.cells[k].outputs, book.cells[k].execution_count = [], None
    execute(book, FIRST_HOUR.parent)
    if os.environ.get("WRITE_NOTEBOOK"):
        book.metadata = stored.metadata  # without the version of Python
        nbformat.write(book, FIRST_HOUR)
        return
    for k in codes:
        assert outputs(book.cells[k]) == outputs(stored.cells[k]), stored.cells[k].source
    shown = [text for k in codes for text in outputs(stored.cells[k])]
    assert shown.count("picture") == 2
    assert any("doubt: " in text for text in shown) and any("\n...\nyes\n" in text for text in shown)
    assert not any("stderr" in text or tempfile.gettempdir() in text for text in shown)


@pytest.mark.skipif(os.name == "nt", reason="the button is no signal there")
@pytest.mark.filterwarnings("ignore")
def test_notebook(tmp_path: Path) -> None:
    needs("nbclient", "ipykernel")
    from nbformat import v4

    blocks = [block[1] for block in re.finditer(r"```python\n(.*?)```", README, re.DOTALL)]
    book = v4.new_notebook(cells=[v4.new_code_cell(text) for text in [*blocks, CHILDREN, STOP]])
    execute(book, tmp_path)
    assert len(blocks) > 4 and all(cell.execution_count for cell in book.cells)
