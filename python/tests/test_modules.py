"""The modules of the package import each other in one direction only, and each can be imported first."""

import ast
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import frond
import pytest

FOLDER = Path(frond.__file__).parent
MODULES = sorted(path.stem for path in FOLDER.glob("_*.py") if path.stem != "__init__")


def imports_of(module):
    """Modules of the package that a module imports anywhere, also inside functions."""
    found = set()
    for node in ast.walk(ast.parse((FOLDER / f"{module}.py").read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            found |= {node.module} if node.module else {name.name for name in node.names}
    return found & set(MODULES)


def test_no_module_imports_another_in_a_circle():
    graph = {module: imports_of(module) for module in MODULES}
    assert graph["_jobs"] >= {"_records", "_session"}  # so that imports are found at all
    list(TopologicalSorter(graph).static_order())  # raises CycleError


@pytest.mark.parametrize("module", [m for m in MODULES if m not in ("_command", "_stubs")])  # programs
def test_each_module_can_be_the_first(module):
    """Without `frond/__init__.py`, which imports all in an order that works."""
    code = (f"import sys, types\npackage = sys.modules['frond'] = types.ModuleType('frond')\npackage.__path__ = [{str(FOLDER)!r}]\n"
            f"import frond.{module}")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
