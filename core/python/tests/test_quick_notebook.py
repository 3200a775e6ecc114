"""The notebook, cell by cell and without Jupyter; cells that need a package which is not there are skipped by name."""

from __future__ import annotations

import ast
import importlib.util
import json
import os
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from study import DEMO, OnTheDemo, skip

NOTEBOOK = json.loads((Path(__file__).parent.parent / "examples/film.ipynb").read_text(encoding="utf-8"))
CELLS = [("".join(cell["source"]), cell["id"]) for cell in NOTEBOOK["cells"] if cell["cell_type"] == "code"]


def missing(tree: ast.AST) -> list[str]:
    """Packages that a cell imports and that are not there."""
    names = [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
    names += [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    packages = {name.partition(".")[0] for name in names}
    return sorted(package for package in packages if importlib.util.find_spec(package) is None)


def names(tree: ast.AST, kind: type[ast.expr_context]) -> set[str]:
    """Names that a cell reads (`ast.Load`) or gives (`ast.Store`)."""
    found = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, kind)}
    if kind is ast.Store:
        imports = (node for node in ast.walk(tree) if isinstance(node, (ast.Import, ast.ImportFrom)))
        found |= {alias.asname or alias.name.partition(".")[0] for node in imports for alias in node.names}
    return found


class Cells(OnTheDemo):
    """A test a cell, in their order, all on the same names."""

    known: dict[str, Any] = {}
    unknown: set[str] = set()

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        environment = patch.dict(os.environ, FLUOROPOSE_DEMO=str(DEMO.absolute()), MPLBACKEND="Agg")
        environment.start()
        cls.addClassCleanup(environment.stop)
        cls.addClassCleanup(os.chdir, os.getcwd())
        os.chdir(cls.folder)

    def execute(self, source: str, name: str) -> None:
        tree = ast.parse(source)
        given = sorted(names(tree, ast.Load) & self.unknown)
        needed = missing(tree) or [f"{name} of a skipped cell" for name in given]
        if needed:
            self.unknown.update(names(tree, ast.Store))
            skip(self, f"{name} of the notebook needs {', '.join(needed)}")
        exec(compile(tree, name, "exec"), self.known)

    def test_z_what_they_leave(self) -> None:
        """After the last cell: poses, and a joint that is written."""
        self.assertEqual(self.known["femoral"].shape, (2, 6))
        self.assertTrue(np.isfinite(self.known["joint"].values).all())
        self.assertTrue((self.folder / "joint.csv").is_file())


def of_cell(source: str, name: str) -> Callable[[Cells], None]:
    def test(self: Cells) -> None:
        self.execute(source, name)

    return test


for number, (source, name) in enumerate(CELLS):
    setattr(Cells, f"test_{number:02}_{name.replace('-', '_')}", of_cell(source, name))


if __name__ == "__main__":
    unittest.main()
