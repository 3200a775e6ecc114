"""The files: what the libraries ship, and what their encoders make."""

import glob
import os

import made
import random_images


def files(folder):
    """Path, name and kind of each file."""
    out = []
    out += shipped("pydicom", "data/test_files", "dicom", lambda path: not path.endswith((".txt", ".json", ".dump", ".icc", ".gz")))
    out += shipped("pydicom", "data/charset_files", "dicom", lambda path: path.endswith(".dcm"))
    pictures = (".png", ".jpg", ".tif", ".tiff", ".jp2")
    for package, sub in [("skimage", "data"), ("scipy", "ndimage/tests"), ("imageio", "resources")]:
        out += shipped(package, sub, None, lambda path: path.lower().endswith(pictures))
    out += made.files(os.path.join(folder, "made"))
    return out + list(random_images.files(os.path.join(folder, "random")))


def shipped(package, sub, kind, wanted):
    root = os.path.join(os.path.dirname(__import__(package).__file__), sub)
    paths = sorted(path for path in glob.glob(root + "/**/*", recursive=True) if os.path.isfile(path) and wanted(path))
    return [(path, f"{package}/{os.path.relpath(path, root)}", kind or kind_of(path)) for path in paths]


def kind_of(path):
    return "tiff" if path.lower().endswith((".tif", ".tiff")) else "picture"


def is_grey_of_pydicom(path, name):
    """The monochrome files of 8 to 16 bits among pydicom's test files."""
    if not name.startswith("pydicom/") or "/charset_files/" in path:
        return False
    import pydicom

    data = pydicom.dcmread(path, force=True, stop_before_pixels=True)
    return str(data.get("PhotometricInterpretation", "")).startswith("MONOCHROME") and data.get("BitsAllocated") in (8, 16)
