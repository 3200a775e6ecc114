"""What other readers make of a file, in the convention of fluoropose-decode: a list of frames, and how far lossy coding may differ."""

import numpy as np

import random_images

# Grey levels (of 256) that two right decoders of one lossy image may differ by at a pixel; more where colours were shared by pixels.
LOSSY, LOSSY_COLOUR = 2, 4
LOSSY_SYNTAXES = {"1.2.840.10008.1.2.4." + end for end in ("50", "51", "91", "112", "203")}


def luminance(colour):
    """ITU-R BT.601 in thousandths, rounded; of the first three channels, or the only one."""
    if colour.shape[-1] < 3:
        return colour[..., 0].astype(np.int64)
    red, green, blue = (colour[..., i].astype(np.int64) for i in range(3))
    return (299 * red + 587 * green + 114 * blue + 500) // 1000


def frames_of(array, samples, count):
    """A list of grey frames from what a reader gave of `count` frames."""
    array = np.asarray(array)
    array = array.reshape((count,) + (array.shape[-3:] if samples > 1 else array.shape[-2:]))
    return [luminance(one) if samples > 1 else one.astype(np.int64) for one in array]


def dicom(path):
    import pydicom
    from pydicom.pixels import apply_color_lut

    data = pydicom.dcmread(path, force=True)
    if "FileMetaInformationVersion" not in data.file_meta and "TransferSyntaxUID" not in data.file_meta:
        explicit, little = data.original_encoding[0] is False, data.original_encoding[1]
        names = {(True, True): "ExplicitVRLittleEndian", (True, False): "ExplicitVRBigEndian", (False, True): "ImplicitVRLittleEndian"}
        data.file_meta.TransferSyntaxUID = getattr(pydicom.uid, names[(explicit, little)])
    syntax = data.file_meta.TransferSyntaxUID
    array = data.pixel_array
    count = int(data.get("NumberOfFrames", 1) or 1)
    samples = int(data.SamplesPerPixel)
    kind = data.PhotometricInterpretation
    if kind == "PALETTE COLOR":
        coloured = apply_color_lut(array, data)
        return frames_of(coloured, 3, count), 0, f"{syntax.name}, palette"
    frames = frames_of(array, samples, count)
    if samples > 1:
        bits = int(data.BitsStored)
        # Luminance is taken as it is stored, and pydicom turns it into red, green and blue and cuts those to their range.
        lossless = kind in ("RGB", "YBR_RCT") and syntax not in LOSSY_SYNTAXES
        return frames, 0 if lossless else LOSSY_COLOUR << max(bits - 8, 0), f"{syntax.name}, {kind}"
    bits, signed = int(data.BitsStored), int(data.PixelRepresentation) == 1
    slope = float(data.get("RescaleSlope", 1) or 1)
    tolerance = LOSSY << max(bits - 8, 0) if syntax in LOSSY_SYNTAXES else 0
    if bits > 16:
        return narrowed(frames, signed), tolerance, f"{syntax.name}, {bits} bits"
    most = (1 << bits) - 1
    frames = [frame + (1 << bits - 1) if signed else frame & most for frame in frames]
    if (kind == "MONOCHROME1") != (slope < 0):
        frames = [most - frame for frame in frames]
    return frames, tolerance, f"{syntax.name}, {bits} bits"


def narrowed(frames, signed):
    """Greys of more than 16 bits: the highest 16 bits that the file's values use."""
    low = min(int(frame.min()) for frame in frames) if signed else 0
    high = max(int(frame.max()) for frame in frames) - low
    shift = max(high.bit_length() - 16, 0)
    return [(frame - low) >> shift for frame in frames]


def tiff(path):
    import tifffile

    frames, tolerance, words = [], 0, set()
    with tifffile.TiffFile(path) as file:
        for page in file.pages:
            if page.is_reduced:
                continue
            frames.append(tiff_page(page))
            words.add(f"{page.compression.name} {page.photometric.name} {page.dtype}")
            if page.compression.name == "JPEG":
                tolerance = LOSSY_COLOUR if page.samplesperpixel > 1 else LOSSY
        words.add("big endian" if file.byteorder == ">" else "little endian")
    return frames, tolerance, ", ".join(sorted(words))


def tiff_page(page):
    array = page.asarray()
    if page.photometric.name == "PALETTE":
        table = np.asarray(page.colormap)
        table = table // 257 if np.all(table % 257 == 0) else table
        return luminance(np.moveaxis(table[:, array], 0, -1))
    if page.samplesperpixel > 1:
        array = np.moveaxis(array, 0, -1) if page.planarconfig == 2 else array
        if array.shape[-1] == 2:
            array = array[..., :1]
        if array.dtype.kind == "f":
            red, green, blue = (array[..., i].astype(np.float64) for i in range(3))
            return as_pixels(0.299 * red + 0.587 * green + 0.114 * blue)
        return luminance(array)
    bits = page.bitspersample
    if array.dtype.kind == "f":
        return as_pixels(array.astype(np.float64))
    if array.dtype.kind == "i":
        array = array.astype(np.int64) + (1 << bits - 1) if bits <= 16 else array.astype(np.int64)
    array = array.astype(np.int64)
    if bits > 16:
        fits = array.min() >= 0 and array.max() <= 65535
        return array if fits else stretched(array.astype(np.float64))
    most = (1 << bits) - 1
    if page.photometric.name == "MINISWHITE":
        array = most - array
    return array * 255 // most if bits < 8 else array


def as_pixels(array):
    """Floating point: as it is where it is whole and fits 16 bits."""
    whole = np.all(np.isfinite(array)) and np.all(array == np.floor(array))
    return array.astype(np.int64) if whole and array.min() >= 0 and array.max() <= 65535 else stretched(array)


def numpy(path):
    """An array: frames before rows and columns, colours behind them; all its frames are mapped alike."""
    array = np.load(path)
    kind = f"NumPy {array.dtype.str}, {array.ndim} axes, {'columns' if np.isfortran(array) else 'rows'}"
    if array.dtype == bool:
        array = array * np.uint8(255)
    if array.shape[-1] == 3:
        return [luminance(array)], 0, kind
    if array.dtype.kind != "u" or array.dtype.itemsize > 2:
        array = as_pixels(array.astype(np.float64))
    return list(np.atleast_3d(array.T).T.astype(np.int64)), 0, kind


def stretched(array):
    """Smallest to largest finite value onto 0 to 65535."""
    finite = array[np.isfinite(array)]
    low, high = finite.min(), finite.max()
    scale = 65535 / (high - low) if high > low else 0
    with np.errstate(invalid="ignore"):
        out = np.nan_to_num((array - low) * scale, nan=0, posinf=65535, neginf=0)
    return np.floor(np.clip(out, 0, 65535) + 0.5).astype(np.int64)


def picture(path):
    """PNG, JPEG, JPEG 2000 and the rest, by Pillow, or by imagecodecs where Pillow knows 8 bits alone."""
    import imagecodecs
    from PIL import Image

    with Image.open(path) as image:
        kind, mode = image.format, image.mode
        if kind == "PNG":
            return [png(path, image)], 0, f"PNG {mode}"
        if kind == "JPEG2000":
            with open(path, "rb") as file:
                array = imagecodecs.jpeg2k_decode(file.read())
            bits = 8 * array.dtype.itemsize
            grey = luminance(array) if array.ndim == 3 else array.astype(np.int64)
            return [grey + (1 << bits - 1) if array.dtype.kind == "i" else grey], 0, f"JPEG 2000 {mode}"
        array = np.asarray(image.convert("RGB") if mode not in ("L", "RGB") else image)
        grey = luminance(array) if array.ndim == 3 else array.astype(np.int64)
        return [grey], LOSSY_COLOUR if array.ndim == 3 else LOSSY, f"{kind} {mode}"


def random_image(path, kind):
    array, tolerance = random_images.decoded(path, kind)
    return [luminance(array) if array.ndim == 3 else np.atleast_2d(array).astype(np.int64)], tolerance, kind


def png(path, image):
    import imagecodecs

    if image.mode == "P":
        return luminance(np.asarray(image.convert("RGB")))
    with open(path, "rb") as file:
        array = np.asarray(imagecodecs.png_decode(file.read()))
    # Transparency is left out.
    return luminance(array[..., :3] if array.shape[-1] > 2 else array[..., :1]) if array.ndim == 3 else array.astype(np.int64)
