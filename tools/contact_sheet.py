"""Puts the PNG files of a folder side by side, with their names: contact_sheet.py COLUMNS OUT.png FOLDER"""
import pathlib
import sys

from PIL import Image, ImageDraw

columns, out, folder = int(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
files = sorted(folder.glob("*.png"))
pictures = [Image.open(f).convert("RGB") for f in files]
width, height = pictures[0].size
sheet = Image.new("RGB", (columns * width, -(-len(pictures) // columns) * height))
draw = ImageDraw.Draw(sheet)
for i, (file, picture) in enumerate(zip(files, pictures)):
    x, y = i % columns * width, i // columns * height
    sheet.paste(picture, (x, y))
    draw.text((x + 6, y + height - 16), file.stem, fill=(230, 230, 230))
sheet.quantize(256).save(out, optimize=True)
