"""The examples run as they are; the one that optimises with Mitsuba in scripts/test --slow alone."""

import os
import sys
from pathlib import Path

import pytest

nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")
import nbformat

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


@pytest.mark.parametrize("name", sorted(p.name for p in EXAMPLES.glob("*.ipynb")))
def test_a_notebook(name, tmp_path, monkeypatch):
    if name == "chlorophyll_map.ipynb":
        if os.environ.get("FROND_SLOW_TESTS") != "1":
            pytest.skip("takes a minute; FROND_SLOW_TESTS=1 runs it")
        pytest.importorskip("mitsuba")
        if "DRJIT_LIBLLVM_PATH" not in os.environ and not os.path.exists("/usr/lib/x86_64-linux-gnu/libLLVM-19.so"):
            pytest.skip("libllvm19 is not installed")
        monkeypatch.setenv("DRJIT_LIBLLVM_PATH", os.environ.get("DRJIT_LIBLLVM_PATH", "/usr/lib/x86_64-linux-gnu/libLLVM-19.so"))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    monkeypatch.setenv("FROND_SOURCE", str(EXAMPLES.parents[1]))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    notebook = nbformat.read(EXAMPLES / name, as_version=4)
    nbclient.NotebookClient(notebook, timeout=None, resources={"metadata": {"path": str(tmp_path)}}).execute()
