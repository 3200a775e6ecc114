"""Prints the paths of whole files, which `cargo xtask fuzz` changes: those of `conformance`, and small models."""

import os
import sys

import reference

TETRAHEDRON = [(0, 0, 0), (40, 0, 0), (0, 30, 0), (0, 0, 20)]
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


def models():
    import struct

    numbers = lambda values: " ".join(str(value) for value in values)
    yield "small.obj", "".join(f"v {numbers(v)}\n" for v in TETRAHEDRON) + "".join(f"f {numbers(i + 1 for i in f)}\n" for f in FACES)
    head = "ply\nformat {} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\nproperty list uint int vertex_indices\nend_header\n"
    rows = [numbers(v) for v in TETRAHEDRON] + [f"3 {numbers(f)}" for f in FACES]
    yield "ascii.ply", head.format("ascii") + "\n".join(rows) + "\n"
    packed = b"".join(struct.pack("<3f", *v) for v in TETRAHEDRON) + b"".join(struct.pack("<I3i", 3, *f) for f in FACES)
    yield "binary.ply", head.format("binary_little_endian").encode() + packed
    facets = [[TETRAHEDRON[i] for i in f] for f in FACES]
    lines = ["facet normal 0 0 1\nouter loop\n" + "".join(f"vertex {numbers(v)}\n" for v in facet) + "endloop\nendfacet\n" for facet in facets]
    yield "ascii.stl", "solid small\n" + "".join(lines) + "endsolid small\n"
    triangles = [struct.pack("<3f", 0, 0, 1) + b"".join(struct.pack("<3f", *v) for v in facet) + b"\0\0" for facet in facets]
    yield "binary.stl", b"\0" * 80 + struct.pack("<I", 4) + b"".join(triangles)


def main():
    folder = sys.argv[1]
    # Of the random images, which are many and alike, every tenth.
    files = [file for file in reference.files(folder) if not file[1].startswith("random/") or file[1].endswith("0")]
    paths = [path for path, _, _ in files]
    for name, content in models():
        paths.append(os.path.join(folder, "made", name))
        with open(paths[-1], "wb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
    print("\n".join(paths))


main()
