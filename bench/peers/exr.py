# SPDX-License-Identifier: Apache-2.0
"""Reads the scanline OpenEXR files that Blender and Aglow write (no compression, ZIPS or ZIP)."""
import array
import struct
import zlib

LINES_PER_BLOCK = {0: 1, 2: 1, 3: 16}  # by compression: none, ZIPS, ZIP


def read_string(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def read_header(data):
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("not an OpenEXR file")
    attributes, at = {}, 8
    while data[at]:
        name, at = read_string(data, at)
        _, at = read_string(data, at)
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def read_channels(listing):
    channels, at = [], 0
    while listing[at]:
        name, at = read_string(listing, at)
        kind, = struct.unpack_from("<i", listing, at)
        channels.append((name, kind))
        at += 16
    return channels


def undo_zip(packed, size):
    """Zlib, then the running difference of bytes, then their interleaving."""
    if len(packed) == size:
        return packed
    raw = bytearray(zlib.decompress(packed))
    for i in range(1, len(raw)):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    half = (len(raw) + 1) // 2
    result = bytearray(len(raw))
    result[0::2] = raw[:half]
    result[1::2] = raw[half:]
    return bytes(result)


def read_row(raw, at, kind, width):
    if kind == 2:
        return array.array("f", raw[at:at + 4 * width]), at + 4 * width
    if kind == 1:
        return array.array("f", struct.unpack_from(f"<{width}e", raw, at)), at + 2 * width
    raise ValueError("channels must hold floats")


def read_exr(path):
    """(width, height, {channel: array of floats, row 0 on top})."""
    with open(path, "rb") as file:
        data = file.read()
    header, at = read_header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    compression = header["compression"][0]
    lines = LINES_PER_BLOCK[compression]
    channels = read_channels(header["channels"])
    row_bytes = width * sum(2 if kind == 1 else 4 for _, kind in channels)
    planes = {name: array.array("f", bytes(4 * width * height)) for name, _ in channels}
    block_count = (height + lines - 1) // lines
    for offset in struct.unpack_from(f"<{block_count}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(lines, y1 + 1 - y)
        raw = data[offset + 8:offset + 8 + size]
        if compression:
            raw = undo_zip(raw, rows * row_bytes)
        cursor = 0
        for row in range(y - y0, y - y0 + rows):
            for name, kind in channels:
                values, cursor = read_row(raw, cursor, kind, width)
                planes[name][row * width:(row + 1) * width] = values
    return width, height, planes


def read_rgb(path):
    """Width, height and the pixels' three planes R, G, B."""
    width, height, planes = read_exr(path)
    return width, height, [planes[name] for name in "RGB"]
