"""Fields that are left out have defaults, and a wrong one is told with those that there are.

maulstick schema --json | python fields.py
"""

import json, pathlib, sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "msgs/python"))
import maulstick

tables = {message["name"]: maulstick.Table(message) for message in json.load(sys.stdin)["messages"]}
sample = tables["StylusSample"]


def refused(value, *words):
    try:
        sample.encode(value)
    except maulstick.FieldError as error:
        missing = [word for word in words if word not in str(error)]
        if missing:
            sys.exit(f"{value}: {error} lacks {missing}")
    else:
        sys.exit(f"{value} is no sample")


pen = sample.decode(sample.encode({"pose": {"Contact": {"point_m": [0.01, 0, 0], "pressure": 0.5}}}))
hand = sample.decode(sample.encode({"pose": {"Ferrule": {"pose": {"position_m": [0, 0, 0.1]}}}}))
if (pen["senses"], hand["senses"], pen["in_range"]) != (5, 3, True):
    sys.exit(f"{pen} {hand}")
if pen["pose"]["Contact"]["tilt_rad"] == [0, 0] or hand["pose"]["Ferrule"]["pose"]["orientation"] != [0, 0, 0, 1]:
    sys.exit(f"{pen} {hand}")
for name, table in tables.items():
    try:
        table.decode(table.encode({}))
    except maulstick.FieldError as error:
        if "one of" not in str(error):
            sys.exit(f"{name}: {error}")
fields = list(sample.fields())
refused({}, "pose", "Contact", "Ferrule", "pressure")
refused({"pose": {"Contact": {}}, "presure": 1}, "presure", *fields)
refused({"pose": {"Contact": {"presure": 1}}}, "presure", "pressure", "tilt_rad")
refused({"pose": {"Pen": {}}}, "Pen", "Contact", "Ferrule")
refused({"pose": {"Contact": {"pressure": "much"}}}, "pressure", "f64", "much")
refused({"pose": {"Contact": {"point_m": [1, 2]}}}, "point_m", "3")
refused(7, *fields)
print("ok")
