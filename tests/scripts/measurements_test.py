"""The measurements and the leaf benchmark, most of which take too long for a test: every name that they use is defined, and what they import from each other
exists."""

import ast
import builtins
import pathlib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def names_of(tree):
    """The names that a module defines or imports anywhere, and those that it uses."""
    defined, used = {*dir(builtins), "__file__"}, set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            (used if isinstance(node.ctx, ast.Load) else defined).add(node.id)
        elif isinstance(node, ast.arg):
            defined.add(node.arg)
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef, ast.ExceptHandler)):
            defined.add(node.name)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            defined |= {(name.asname or name.name).split(".")[0] for name in node.names}
    return defined, used


class Names(unittest.TestCase):
    def setUp(self):
        self.trees = {path: ast.parse(path.read_text(encoding="utf-8")) for folder in ("measurements", "leaf_benchmark") for path in (ROOT / folder).rglob("*.py")}
        self.assertGreater(len(self.trees), 50)

    def test_every_name_is_defined(self):
        for path, tree in self.trees.items():
            defined, used = names_of(tree)
            self.assertEqual(used - defined, set(), path)

    def test_relative_imports_lead_to_modules_and_their_names(self):
        for path, tree in self.trees.items():
            for node in ast.walk(tree):
                if not isinstance(node, ast.ImportFrom) or not node.level:
                    continue
                base = path.parents[node.level - 1] / (node.module or "").replace(".", "/")
                module = next((p for p in (base.with_suffix(".py"), base / "__init__.py") if p.is_file()), None)
                for name in (alias.name for alias in node.names):
                    is_module = base.is_dir() and ((base / f"{name}.py").is_file() or (base / name).is_dir())
                    self.assertTrue(is_module or module and name in names_of(self.trees[module])[0], f"{path}: {name}")

    def test_a_name_that_is_not_defined_is_found(self):
        defined, used = names_of(ast.parse("import a.b\nfor x in a.c(y):\n    print(x)"))
        self.assertEqual(used - defined, {"y"})


if __name__ == "__main__":
    unittest.main()
