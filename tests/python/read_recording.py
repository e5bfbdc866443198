"""Counts the messages of a topic in a recording, by msgs/python/maulstick.py.

python read_recording.py RECORDING TOPIC
"""

import pathlib, sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "msgs/python"))
import maulstick

read = list(maulstick.recording(sys.argv[1], sys.argv[2]))
assert all(fields["push"][0] == 0.25 for _, _, _, fields in read), "not what was sent"
print(len(read))
