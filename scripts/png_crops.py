#!/usr/bin/env python3
"""Cuts parts out of a PNG picture of the program and puts them side by side, enlarged by whole numbers.

png_crops.py IN.png OUT.png SCALE X,Y,W,H [X,Y,W,H ...]   (8 bits per channel, RGB or RGBA; writes RGB)
"""

import struct
import sys
import zlib

GAP_PX = 6
WHITE = b"\xff\xff\xff"


def paeth(left, above, above_left):
    estimate = left + above - above_left
    distances = (abs(estimate - left), abs(estimate - above), abs(estimate - above_left))
    return (left, above, above_left)[distances.index(min(distances))]


def unfilter(kind, line, above, step):
    for i in range(len(line)):
        left = line[i - step] if i >= step else 0
        above_left = above[i - step] if i >= step else 0
        predicted = (0, left, above[i], (left + above[i]) // 2, paeth(left, above[i], above_left))[kind]
        line[i] = (line[i] + predicted) & 255


def read(path):
    """Rows of pixels, each 3 bytes."""
    with open(path, "rb") as file:
        data = file.read()
    position, packed, header = 8, b"", None
    while position < len(data):
        length, name = struct.unpack(">I4s", data[position : position + 8])
        body = data[position + 8 : position + 8 + length]
        position += 12 + length
        if name == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif name == b"IDAT":
            packed += body
    width, height, depth, colour_type, _, _, interlaced = header
    if depth != 8 or colour_type not in (2, 6) or interlaced:
        sys.exit(f"png_crops: error: not a plain RGB or RGBA picture: {path}")
    step = 3 if colour_type == 2 else 4
    raw, stride = zlib.decompress(packed), width * step
    rows, above = [], bytearray(stride)
    for y in range(height):
        begin = y * (stride + 1)
        line = bytearray(raw[begin + 1 : begin + 1 + stride])
        unfilter(raw[begin], line, above, step)
        rows.append([bytes(line[i : i + 3]) for i in range(0, stride, step)])
        above = line
    return rows


def chunk(name, body):
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))


def write(path, rows):
    raw = b"".join(b"\0" + b"".join(row) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)))
        file.write(chunk(b"IEND", b""))


def crop(rows, x, y, width, height, scale):
    result = []
    for row in rows[y : y + height]:
        wide = [pixel for pixel in row[x : x + width] for _ in range(scale)]
        result += [wide] * scale
    return result


def main():
    source, target, scale = sys.argv[1], sys.argv[2], int(sys.argv[3])
    rows = read(source)
    crops = [crop(rows, *map(int, part.split(",")), scale) for part in sys.argv[4:]]
    joined = []
    for lines in zip(*crops):
        row = []
        for i, line in enumerate(lines):
            row += ([WHITE] * GAP_PX if i else []) + line
        joined.append(row)
    write(target, joined)


if __name__ == "__main__":
    main()
