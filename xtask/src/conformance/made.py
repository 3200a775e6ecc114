"""Files that encoders of the Python world make: what the shipped ones lack."""

import os
import sys

import numpy as np

WIDTH, HEIGHT = 37, 29


def picture(bits, seed=1, smooth=True):
    """A grey picture: waves, an edge, a flat part and a little noise."""
    random = np.random.default_rng(seed)
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    value = 0.5 + 0.3 * np.sin(columns / 5) * np.cos(rows / 7) + 0.15 * (columns > 20)
    value[18:, :12] = 0.2
    if not smooth:
        value = value + random.normal(0, 0.02, value.shape)
        value[18:, :12] = 0.2
    return np.clip(value * (2**bits - 1), 0, 2**bits - 1).astype(np.uint8 if bits <= 8 else np.uint16 if bits <= 16 else np.uint32)


def colours(bits=8):
    return np.stack([picture(bits, 1), picture(bits, 2)[::-1], picture(bits, 3)[:, ::-1]], -1).copy()


def files(folder):
    os.makedirs(folder, exist_ok=True)
    out = []
    for make, kind in [(dicoms, "dicom"), (tiffs, "tiff"), (pictures, "picture"), (arrays, "numpy")]:
        for name, write in make():
            path = os.path.join(folder, name)
            try:
                write(path)
            except Exception as error:  # an encoder that is not there
                print(f"not made: {name} ({type(error).__name__}: {error})", file=sys.stderr)
                continue
            out.append((path, f"made/{name}", kind))
    return out


def dicom(pixels, syntax, frames=1, **attributes):
    """A data set; `pixels` are an array, or a list of coded frames."""
    from pydicom import Dataset
    from pydicom.dataset import FileMetaDataset
    from pydicom.encaps import encapsulate
    from pydicom.uid import UID

    data = Dataset()
    data.file_meta = FileMetaDataset()
    data.file_meta.TransferSyntaxUID = UID(syntax)
    data.file_meta.MediaStorageSOPClassUID = data.SOPClassUID = "1.2.840.10008.5.1.4.1.1.12.1"
    data.file_meta.MediaStorageSOPInstanceUID = data.SOPInstanceUID = "1.2.3.4"
    data.Modality, data.PatientName = "XA", "Made^Up"
    data.Rows, data.Columns, data.NumberOfFrames = HEIGHT, WIDTH, frames
    data.SamplesPerPixel, data.PhotometricInterpretation, data.PixelRepresentation = 1, "MONOCHROME2", 0
    data.BitsAllocated = data.BitsStored = 8 if attributes.get("bits", 16) <= 8 else 16
    for name, value in attributes.items():
        if name != "bits":
            setattr(data, name, value)
    if "HighBit" not in attributes:
        data.HighBit = data.BitsStored - 1
    if isinstance(pixels, list):
        data.PixelData = encapsulate(pixels)
        data["PixelData"].VR = "OB"
    else:
        raw = pixels.astype(pixels.dtype.newbyteorder(">" if syntax == BIG else "<")).tobytes()
        data.PixelData = raw + b"\0" * (len(raw) % 2)
        data["PixelData"].VR = "OB" if data.BitsAllocated <= 8 and syntax != IMPLICIT else "OW"
    return data


IMPLICIT, EXPLICIT, BIG, DEFLATED, RLE = ("1.2.840.10008.1.2" + end for end in ("", ".1", ".2", ".1.99", ".5"))
JPEG = "1.2.840.10008.1.2.4."


def write(data, preamble=b"\0" * 128):
    def to(path):
        data.preamble = preamble
        data.save_as(path, enforce_file_format=True)

    return to


def bare(data, implicit, little):
    """Without preamble and the group that names the syntax."""

    def to(path):
        from pydicom.filewriter import dcmwrite

        del data.file_meta
        dcmwrite(path, data, implicit_vr=implicit, little_endian=little)

    return to


def dicoms():
    import imagecodecs as codecs

    deep = {"BitsStored": 12}
    grey, words, noise = picture(8), picture(12), picture(12, smooth=False)
    full = picture(16, smooth=False)
    for name, preamble in [("tiff-le", b"II*\0\x08\0\0\0"), ("tiff-be", b"MM\0*\0\0\0\x08"), ("png", b"\x89PNG\r\n\x1a\n"), ("jpeg", b"\xff\xd8\xff")]:
        yield f"preamble-{name}.dcm", write(dicom(words, EXPLICIT, **deep), preamble.ljust(128, b"\0"))
    yield "bare-implicit.dcm", bare(dicom(words, IMPLICIT, **deep), True, True)
    yield "bare-explicit.dcm", bare(dicom(words, EXPLICIT, **deep), False, True)
    yield "bare-big-endian.dcm", bare(dicom(words, BIG, **deep), False, False)
    for name, syntax in [("implicit", IMPLICIT), ("explicit", EXPLICIT), ("big-endian", BIG), ("deflated", DEFLATED)]:
        for kind in ("MONOCHROME1", "MONOCHROME2"):
            yield f"{kind.lower()}-{name}.dcm", write(dicom(words, syntax, PhotometricInterpretation=kind, **deep))
        yield f"8-bit-{name}.dcm", write(dicom(grey, syntax, bits=8))
        signed = (words.astype(np.int16) - 2048) & 0x0FFF
        yield f"signed-{name}.dcm", write(dicom(signed.astype(np.uint16), syntax, PixelRepresentation=1, **deep))
        yield f"32-bit-{name}.dcm", write(dicom(picture(32), syntax, BitsAllocated=32, BitsStored=32, RescaleSlope="0.5", RescaleIntercept="3"))
        yield f"32-bit-few-{name}.dcm", write(dicom(words.astype(np.uint32), syntax, BitsAllocated=32, BitsStored=32))
        few = np.stack([grey[:, :WIDTH], 255 - grey]) > 128
        packed = np.packbits(few.reshape(-1), bitorder="little")
        packed = packed.reshape(-1, 2)[:, ::-1].reshape(-1) if syntax == BIG and len(packed) % 2 == 0 else packed
        yield f"1-bit-{name}.dcm", write(dicom(packed, syntax if syntax != BIG else EXPLICIT, 2, BitsAllocated=1, BitsStored=1))
        yield f"odd-frames-{name}.dcm", write(dicom(np.stack([grey, grey[::-1], grey // 2]), syntax, 3, bits=8))
        yield f"rgb-16-{name}.dcm", write(dicom(colours(16), syntax, SamplesPerPixel=3, PlanarConfiguration=0, PhotometricInterpretation="RGB"))
    overlay = (words | 0x8000 * (words > 2000)).astype(np.uint16)
    # Stored bits that do not end at the lowest, which the standard once allowed, pydicom cuts off: no file of them here.
    yield "overlay-bits.dcm", write(dicom(overlay, EXPLICIT, **deep))
    yield "falling.dcm", write(dicom(words, EXPLICIT, RescaleSlope="-1", RescaleIntercept="4095", **deep))
    for bits in (8, 16):
        table = np.linspace(0, 2**bits - 1, 256).astype(np.uint8 if bits == 8 else np.uint16)
        shape = {f"{c}PaletteColorLookupTableDescriptor": [256, 0, bits] for c in ("Red", "Green", "Blue")}
        data = {"RedPaletteColorLookupTableData": table.tobytes(), "GreenPaletteColorLookupTableData": table[::-1].tobytes(), "BluePaletteColorLookupTableData": np.roll(table, 99).tobytes()}
        yield f"palette-{bits}.dcm", write(dicom(grey, EXPLICIT, bits=8, PhotometricInterpretation="PALETTE COLOR", **shape, **data))
    yield "times.dcm", write(dicom(np.stack([words] * 4), EXPLICIT, 4, FrameTime="66.67", CineRate="15", **deep))
    for near in (0, 1, 3):
        end = "80" if near == 0 else "81"
        for name, array, extra in [("8", grey, {"bits": 8}), ("12", noise, deep), ("16", full, {})]:
            yield f"ls-{name}-near-{near}.dcm", write(dicom([codecs.jpegls_encode(array, level=near)] * 2, JPEG + end, 2, **extra))
        rgb = {"SamplesPerPixel": 3, "PlanarConfiguration": 0, "PhotometricInterpretation": "RGB", "bits": 8}
        yield f"ls-rgb-near-{near}.dcm", write(dicom([codecs.jpegls_encode(colours(), level=near)], JPEG + end, **rgb))
    yield "extended-12.dcm", write(dicom([codecs.jpeg8_encode(words, level=95, bitspersample=12)], JPEG + "51", **deep))
    yield "extended-12-coarse.dcm", write(dicom([codecs.jpeg8_encode(noise, level=60, bitspersample=12)], JPEG + "51", **deep))
    yield "baseline.dcm", write(dicom([codecs.jpeg8_encode(grey, level=90)], JPEG + "50", bits=8))
    for bits, array in [(8, grey), (12, noise), (16, full)]:
        extra = {"bits": bits} if bits != 12 else deep
        yield f"lossless-{bits}.dcm", write(dicom([codecs.ljpeg_encode(array, bitspersample=bits)], JPEG + "70", **extra))
        yield f"j2k-{bits}.dcm", write(dicom([codecs.jpeg2k_encode(array, codecformat="j2k", reversible=True)], JPEG + "90", **extra))
        yield f"htj2k-{bits}.dcm", write(dicom([codecs.htj2k_encode(array, reversible=True)], JPEG + "201", **extra))
    yield from blank_dicoms()


def blank_dicoms():
    """Frames before the exposure, of which a compressed image is some hundred bytes."""
    import imagecodecs as codecs

    for side in (512, 1024):
        blank = np.zeros((side, side), np.uint16)
        shape = {"Rows": side, "Columns": side}
        yield f"blank-{side}-deflated.dcm", write(dicom(blank, DEFLATED, **shape))
        yield f"blank-{side}-ls.dcm", write(dicom([codecs.jpegls_encode(blank)], JPEG + "80", **shape))
        yield f"blank-{side}-lossless.dcm", write(dicom([codecs.ljpeg_encode(blank, bitspersample=16)], JPEG + "70", **shape))
        yield f"blank-{side}-j2k.dcm", write(dicom([codecs.jpeg2k_encode(blank, codecformat="j2k", reversible=True)], JPEG + "90", **shape))
        yield f"blank-{side}-baseline.dcm", write(dicom([codecs.jpeg8_encode(blank.astype(np.uint8))], JPEG + "50", bits=8, **shape))
        yield f"blank-{side}-rle.dcm", compressed(dicom(blank, EXPLICIT, **shape), RLE)


def compressed(data, syntax):
    def to(path):
        data.compress(syntax, generate_instance_uid=False)
        write(data)(path)

    return to


def tiffs():
    import tifffile

    def save(array, **options):
        return lambda path: tifffile.imwrite(path, array, **options)

    grey, words = picture(8), picture(16, smooth=False)
    float32 = (words / 7.0 - 3).astype(np.float32)
    for order, name in [("<", "little"), (">", "big")]:
        for big in (False, True):
            layout = {"byteorder": order, "bigtiff": big, "metadata": None}
            kind = f"{name}{'-big' if big else ''}"
            yield f"8-{kind}.tif", save(grey, **layout)
            yield f"16-{kind}.tif", save(words, **layout)
            yield f"32-{kind}.tif", save(picture(32), **layout)
            yield f"signed-16-{kind}.tif", save((words.astype(np.int32) - 32768).astype(np.int16), **layout)
            yield f"float-{kind}.tif", save(float32, **layout)
            yield f"double-{kind}.tif", save(float32.astype(np.float64), **layout)
            yield f"half-{kind}.tif", save((words / 65535).astype(np.float16), **layout)
        for compression in ("lzw", "deflate", "packbits", "zstd", "lzma", "jpeg", "jpegxl", "jpeg2000"):
            for array, bits in [(grey, 8), (words, 16)]:
                missing = [("jpeg", 16, "<"), ("jpeg", 16, ">"), ("jpegxl", 16, ">")]
                if (compression, bits, order) not in missing:
                    yield f"{compression}-{bits}-{name}.tif", save(array, compression=compression, byteorder=order)
        for compression in ("lzw", "deflate"):
            for array, bits in [(grey, 8), (words, 16), (picture(32), 32), (float32, "float"), (colours(), "rgb")]:
                yield f"predicted-{compression}-{bits}-{name}.tif", save(array, compression=compression, predictor=True, byteorder=order, photometric="rgb" if bits == "rgb" else "minisblack")
        yield f"tiles-{name}.tif", save(words, tile=(16, 16), byteorder=order)
        yield f"tiles-deflate-{name}.tif", save(words, tile=(16, 32), compression="deflate", predictor=True, byteorder=order)
    yield "pages.tif", save(np.stack([words, words[::-1], words // 2]), photometric="minisblack")
    yield "planes-rgb.tif", save(np.moveaxis(colours(), -1, 0).copy(), photometric="rgb", planarconfig="separate")
    yield "planes-rgb-16.tif", save(np.moveaxis(colours(16), -1, 0).copy(), photometric="rgb", planarconfig="separate")
    yield "planes-rgb-tiles.tif", save(np.moveaxis(colours(), -1, 0).copy(), photometric="rgb", planarconfig="separate", tile=(16, 16), compression="lzw")
    yield "rgb-16.tif", save(colours(16), photometric="rgb")
    yield "rgb-float.tif", save((colours(16) / 65535).astype(np.float32), photometric="rgb")
    yield "rgba.tif", save(np.dstack([colours(), grey]), photometric="rgb", extrasamples=["unassalpha"])
    yield "grey-alpha.tif", save(np.dstack([grey, grey]), photometric="minisblack", planarconfig="contig", extrasamples=["unassalpha"])
    yield "white-is-zero-8.tif", save(grey, photometric="miniswhite")
    yield "white-is-zero-16.tif", save(words, photometric="miniswhite")
    yield "jpeg-rgb.tif", save(colours(), photometric="rgb", compression="jpeg")
    yield "bilevel.tif", save(grey > 128, photometric="minisblack")
    yield "bilevel-white-is-zero.tif", save(grey > 128, photometric="miniswhite")
    table = np.stack([np.linspace(0, 65535, 256), np.linspace(65535, 0, 256), np.full(256, 257 * 9)]).astype(np.uint16)
    yield "palette.tif", save(grey, photometric="palette", colormap=table)
    yield from pillow_tiffs(grey)


def pillow_tiffs(grey):
    from PIL import Image

    def save(image, **options):
        return lambda path: image.save(path, **options)

    bilevel = Image.fromarray(grey).point(lambda value: 255 * (value > 128)).convert("1")
    for compression in ("group3", "group4", "tiff_ccitt", "packbits", "tiff_lzw", "tiff_adobe_deflate"):
        yield f"bilevel-{compression}.tif", save(bilevel, compression=compression)
    yield "jpeg-ycbcr.tif", save(Image.fromarray(colours()), compression="jpeg")


def bitmaps(grey):
    from PIL import Image

    yield "grey.bmp", Image.fromarray(grey)
    yield "bilevel.bmp", Image.fromarray(grey).convert("1")
    yield "rgb.bmp", Image.fromarray(colours())
    yield "rgba.bmp", Image.fromarray(np.dstack([colours(), grey]))
    palette = Image.fromarray(grey).convert("P")
    palette.putpalette([value for i in range(256) for value in (255 - 3 * i % 256, 40 * i % 256, i)])
    yield "palette.bmp", palette


def pictures():
    from PIL import Image
    import imagecodecs as codecs

    def save(image, **options):
        return lambda path: image.save(path, **options)

    def dump(content):
        def to(path):
            with open(path, "wb") as file:
                file.write(content)

        return to

    grey, words = picture(8), picture(16)
    yield "grey.png", save(Image.fromarray(grey))
    yield "grey-16.png", dump(codecs.png_encode(words))
    yield "rgb.png", save(Image.fromarray(colours()))
    yield "rgb-16.png", dump(codecs.png_encode(colours(16)))
    yield "rgba.png", save(Image.fromarray(np.dstack([colours(), grey])))
    yield "grey-alpha.png", save(Image.fromarray(np.dstack([grey, grey])))
    yield "grey-alpha-16.png", dump(codecs.png_encode(np.dstack([words, words])))
    for bits in (1, 2, 4, 8):
        image = Image.fromarray(grey >> (8 - bits)).convert("P")
        image.putpalette([value for i in range(1 << bits) for value in (255 - 3 * i % 256, 40 * i % 256, i)])
        yield f"palette-{bits}.png", save(image, bits=bits)
    yield "bilevel.png", save(Image.fromarray(grey).convert("1"))
    for name, image in bitmaps(grey):
        yield name, save(image)
    yield "grey.jpg", save(Image.fromarray(grey), quality=92)
    yield "progressive.jpg", save(Image.fromarray(grey), quality=92, progressive=True)
    yield "rgb.jpg", save(Image.fromarray(colours()), quality=92)
    yield "cmyk.jpg", save(Image.fromarray(colours()).convert("CMYK"), quality=92)
    yield "grey.jp2", dump(codecs.jpeg2k_encode(grey, reversible=True))
    yield "grey-16.jp2", dump(codecs.jpeg2k_encode(words, reversible=True))
    yield "rgb.jp2", dump(codecs.jpeg2k_encode(colours(), reversible=True))
    yield "grey.jls", dump(codecs.jpegls_encode(grey))
    for name, mode in [("grey.bmp", "L"), ("rgb.bmp", "RGB"), ("grey.pgm", "L")]:
        yield name, save(Image.fromarray(grey if mode == "L" else colours()))
    yield "grey.webp", save(Image.fromarray(grey), lossless=True)
    yield "grey.gif", save(Image.fromarray(grey))


def arrays():
    def save(array):
        return lambda path: np.save(path, array)

    film = np.stack([picture(16, seed) for seed in (1, 2, 3)])
    for kind in ("u1", "<u2", ">u2", "<i4", ">i8", "<f4"):
        numbers = (film >> 8 if kind == "u1" else film).astype(kind)
        yield f"film-{kind.strip('<>')}-{'big' if kind[0] == '>' else 'little'}.npy", save(numbers)
        yield f"columns-{kind.strip('<>')}-{'big' if kind[0] == '>' else 'little'}.npy", save(np.asfortranarray(numbers))
    yield "negative.npy", save(film.astype(np.int32) - 30000)
    yield "parts.npy", save(film / 65535)
    yield "half.npy", save((film / 65535).astype(np.float16))
    yield "truth.npy", save(film > 30000)
    yield "frame.npy", save(film[0])
    yield "colours.npy", save(colours())
