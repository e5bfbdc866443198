"""Sends samples of a free hand into a rig and hears them again, by msgs/python/maulstick.py.

python echo.py PROGRAM COUNT
"""

import pathlib, sys, threading

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "msgs/python"))
import maulstick

count = int(sys.argv[2])
with maulstick.Rig(program=sys.argv[1]) as rig:
    heard, is_over = [], threading.Event()

    def listen():
        for topic, header, fields in rig.listen("control/*/sample"):
            heard.append((topic, header["seq"], fields["push"][0]))
            if len(heard) == count:
                break
        is_over.set()

    threading.Thread(target=listen, daemon=True).start()
    sender = rig.sender("control/python/sample", "ControlSample")
    while not heard:
        sender.send({"push": [0.25, 0, 0], "turn": [0, 0, 0], "switches": 0})
        is_over.wait(0.02)
    for _ in range(count):
        sender.send({"push": [0.25, 0, 0], "turn": [0, 0, 0], "switches": 0})
    is_over.wait(60)
    numbers = [seq for _, seq, _ in heard]
    assert numbers == list(range(numbers[0], numbers[0] + count)), numbers
    assert all(topic == "control/python/sample" and push == 0.25 for topic, _, push in heard)
print(len(heard))
