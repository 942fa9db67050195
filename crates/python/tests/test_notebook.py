"""The README in a notebook, then children and the button that stops a cell. Skipped without nbclient, unless REQUIRE_EXAMPLES is set."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

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


@pytest.mark.skipif(os.name == "nt", reason="the button is no signal there")
@pytest.mark.filterwarnings("ignore")
def test_notebook(tmp_path: Path) -> None:
    if not os.environ.get("REQUIRE_EXAMPLES"):
        pytest.importorskip("nbclient")
        pytest.importorskip("ipykernel")
    import nbclient
    from nbformat import v4

    blocks = [block[1] for block in re.finditer(r"```python\n(.*?)```", README, re.DOTALL)]
    book = v4.new_notebook(cells=[v4.new_code_cell(text) for text in [*blocks, CHILDREN, STOP]])
    # The interpreter that runs this, whatever kernels are installed.
    nbclient.NotebookClient(book, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert len(blocks) > 4 and all(cell.execution_count for cell in book.cells)
