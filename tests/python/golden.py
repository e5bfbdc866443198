"""Reads the golden bytes of every message and writes them again, by msgs/python/maulstick.py.

maulstick schema --json | python golden.py GOLDEN.txt
"""

import json, pathlib, sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "msgs/python"))
import maulstick

tables = {message["hash"]: maulstick.Table(message) for message in json.load(sys.stdin)["messages"]}
read = 0
for line in open(sys.argv[1]):
    name, _, data = line.split()
    header, body = maulstick.split(bytes.fromhex(data))
    table = tables[header["schema"]]
    value = table.decode(body)
    if name.split("/")[0] != table.name or table.encode(value) != body:
        sys.exit(f"{name} is not written as it was read")
    if table.decode(body + b"more") != value:
        sys.exit(f"{name}: what a newer version appends is no part of it")
    read += 1
print(read)
