"""Holds fluoropose's reader of frames against pydicom, tifffile, Pillow and imagecodecs, on the files that they ship and on made ones.

Run by `cargo xtask conformance`: PROGRAM FOLDER, where PROGRAM is the example `decoded` of fluoropose-decode.
"""

import json
import os
import subprocess
import sys
import warnings

import numpy as np

import oracle
import reference


def ours(program, folder, paths):
    """What the program says of each file, and its frames."""
    pixels = os.path.join(folder, "pixels.bin")
    told = subprocess.run([program, pixels], input="\n".join(paths), capture_output=True, text=True)
    lines = [json.loads(line) for line in told.stdout.splitlines()]
    if len(lines) < len(paths):
        sys.exit(f"the program ended at {paths[len(lines)]}: {told.stderr[-800:]}")
    data, at = np.fromfile(pixels, "<u2"), 0
    for line in lines:
        line["pixels"] = []
        for width, height, _ in line.get("frames", []):
            line["pixels"].append(data[at : at + width * height].reshape(height, width).astype(np.int64))
            at += width * height
    return lines


def theirs(path, kind):
    """Frames, tolerance and a word on the file by its own library; an error's text where that cannot read it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if kind.startswith("random"):
                return oracle.random_image(path, kind)
            return {"dicom": oracle.dicom, "tiff": oracle.tiff, "numpy": oracle.numpy}.get(kind, oracle.picture)(path)
    except Exception as error:  # whatever a library may raise
        return None, 0, f"{type(error).__name__}: {' '.join(str(error).split())[:60]}"


def verdict(line, frames, tolerance):
    refused = line.get("refused")
    if refused:
        return ("refused by both" if frames is None else "REFUSED"), refused
    if frames is None:
        return "read by us alone", ""
    if len(frames) != len(line["pixels"]):
        return "WRONG", f"{len(line['pixels'])} frames for {len(frames)}"
    worst = 0
    for mine, other in zip(line["pixels"], frames):
        if mine.shape != other.shape:
            return "WRONG", f"{mine.shape} pixels for {other.shape}"
        worst = max(worst, int(np.abs(mine - other).max()))
    if worst == 0:
        return "same", ""
    return ("within tolerance" if worst <= tolerance else "WRONG"), f"differs by up to {worst}"


def main():
    program, folder = sys.argv[1:3]
    only = sys.argv[3:]
    files = [file for file in reference.files(folder) if not only or any(word in file[1] for word in only)]
    lines = ours(program, folder, [path for path, _, _ in files])
    totals, grey = {}, [0, 0]
    for (path, name, kind), line in zip(files, lines):
        frames, tolerance, what = theirs(path, kind)
        word, detail = verdict(line, frames, tolerance)
        totals[word] = totals.get(word, 0) + 1
        # Reports, plans, directories; and of the random images those alone that are not read right.
        right = word in ("same", "within tolerance")
        if frames is None and "holds no pixels" in detail or kind.startswith("random") and right:
            continue
        print(f"{word:18}{name}  [{what}]" + (f"\n{'':18}{detail}" if detail else ""))
        if reference.is_grey_of_pydicom(path, name) and frames is not None:
            grey = [grey[0] + (right), grey[1] + 1]
    print("\n" + ", ".join(f"{count} {word}" for word, count in sorted(totals.items())))
    print(f"of pydicom's monochrome files of 8 to 16 bits {grey[0]} of {grey[1]} are read right")
    wrong = totals.get("WRONG", 0)
    sys.exit(f"{wrong} files are read wrong" if wrong else 0)


main()
