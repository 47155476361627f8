# side_by_side.py LEFT RIGHT X0,Y0,X1,Y1 OUT: the same part of two pictures, next to each other.
import sys

from PIL import Image

left, right, box, out = sys.argv[1:]
parts = [Image.open(path).crop(tuple(map(int, box.split(",")))) for path in (left, right)]
width, height = parts[0].size
sheet = Image.new("RGB", (2 * width, height))
for i, part in enumerate(parts):
    sheet.paste(part, (i * width, 0))
sheet.save(out)
