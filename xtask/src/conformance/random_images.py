"""Random images in the codings that fluoropose decodes itself, made by other encoders: JPEG-LS, 12-bit and lossless JPEG."""

import os

import numpy as np

COUNT = 300
# Grey levels of 4096 that two decoders of one image in cosines may differ by.
ROUNDING = 1


def picture(random, rows, columns, most, kind):
    if kind == 0:
        return random.integers(0, most + 1, (rows, columns))
    if kind == 1:
        return np.full((rows, columns), random.integers(0, most + 1))
    if kind == 2:
        return np.add.outer(np.arange(rows) * 3, np.arange(columns) * 2) * most // 400 % (most + 1)
    steps = np.cumsum(random.integers(-2, 3, (rows, columns)), 1)
    walk = np.clip(steps + most // 2, 0, most)
    walk[rows // 3 :, : columns // 2] = most // 3
    return walk


def size(random, index):
    largest = 9 if index % 3 == 0 else 60
    return random.integers(1, largest, 2)


def jpeg_ls(random, index):
    import jpeg_ls as charls

    bits = int(random.integers(2, 17))
    most = (1 << bits) - 1
    near = int(random.integers(0, 1 + min(5, most // 2))) if index % 2 else 0
    rows, columns = map(int, size(random, index))
    word = np.uint8 if bits <= 8 else np.uint16
    shape = {"rows": rows, "columns": columns, "bits_stored": bits, "lossy_error": near}
    if bits <= 8 and index % 5 == 0:
        colours = [picture(random, rows, columns, most, int(kind)) for kind in random.integers(0, 4, 3)]
        order = int(random.integers(0, 3))
        array = np.stack(colours, 0 if order == 0 else -1).astype(word)
        return charls.encode_buffer(array.tobytes(), samples_per_pixel=3, interleave_mode=order, **shape)
    array = picture(random, rows, columns, most, index % 4).astype(word)
    return charls.encode_buffer(array.tobytes(), samples_per_pixel=1, **shape)


def cosines(random, index):
    import imagecodecs

    array = picture(random, *size(random, index), 4095, index % 4).astype(np.uint16)
    return imagecodecs.jpeg8_encode(array, level=int(random.integers(5, 100)), bitspersample=12)


def lossless(random, index):
    import imagecodecs

    bits = int(random.integers(2, 17))
    array = picture(random, *size(random, index), (1 << bits) - 1, index % 4)
    return imagecodecs.ljpeg_encode(array.astype(np.uint8 if bits <= 8 else np.uint16), bitspersample=bits)


KINDS = {"ls": jpeg_ls, "cosines": cosines, "lossless": lossless}


def files(folder):
    os.makedirs(folder, exist_ok=True)
    random = np.random.default_rng(19)
    for kind, encode in KINDS.items():
        for index in range(COUNT):
            try:
                coded = bytes(encode(random, index))
            except (RuntimeError, ValueError):
                # Encoders that reserve too little for small noise, or refuse a depth.
                continue
            path = os.path.join(folder, f"{kind}-{index}.jpg")
            with open(path, "wb") as file:
                file.write(coded)
            yield path, f"random/{kind}-{index}", f"random {kind}"


def decoded(path, kind):
    """By the libraries that the encoders belong to; of lossless JPEG, whose own reads not all of them, by libjpeg."""
    import imagecodecs
    import libjpeg

    with open(path, "rb") as file:
        coded = file.read()
    if kind.endswith("ls"):
        return imagecodecs.jpegls_decode(coded), 0
    if kind.endswith("cosines"):
        return imagecodecs.jpeg8_decode(coded), ROUNDING
    return libjpeg.decode(coded), 0
