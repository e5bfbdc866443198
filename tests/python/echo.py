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
    request = rig.by_name["GapRequest"].encode({"epoch": sender.epoch, "from": numbers[1], "to": numbers[3]})
    head = maulstick.HEADER.pack(0x4D4C, 1, rig.by_name["GapRequest"].hash, 1, 1, 0, len(request), 0, 0, 0)
    replies = rig.session.get(rig.facts["prefix"] + "gap/control/python/sample", payload=head + request)
    (answer,) = [reply.ok.payload.to_bytes() for reply in replies]
    assert answer == b"".join(sender.sent[seq] for seq in numbers[1:4]), "not what was lost"
print(len(heard))
