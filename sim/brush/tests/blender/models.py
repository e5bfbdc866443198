"""Changes the round model in one way at a time: `python models.py TOOLS FOLDER`.

Writes each as FOLDER/NAME.glb, and FOLDER/found.json with what the add-on's check says of it.
"""

import json
import sys
from pathlib import Path

import bpy

tools, folder = map(Path, sys.argv[1:])
sys.path.insert(0, str(tools))
import maulstick_brush
import model_round


def edited(spines, change):
    """Changes an armature's bones in edit mode."""
    bpy.context.view_layer.objects.active = spines
    bpy.ops.object.mode_set(mode="EDIT")
    change(spines.data.edit_bones)
    bpy.ops.object.mode_set(mode="OBJECT")


def add_chain(bones, name, parent, count):
    """Adds a chain of bones of a millimetre."""
    for i in range(count):
        bone = bones.new(f"{name}.{i}")
        bone.head, bone.tail = (1e-3, 1e-3, -i * 1e-3), (1e-3, 1e-3, -(i + 1) * 1e-3)
        bone.parent = parent
        parent = bone


def unweighted(spines, head):
    for group in head.vertex_groups:
        group.remove([17, 30])


def branching(spines, head):
    edited(spines, lambda bones: add_chain(bones, "twig", bones["spine1.1"], 1))


def too_many_joints(spines, head):
    edited(spines, lambda bones: add_chain(bones, "long", bones["ferrule"], 65))


def too_many_spines(spines, head):
    def add(bones):
        for i in range(20):
            add_chain(bones, f"spine{i + 5}", bones["ferrule"], 1)

    edited(spines, add)


def zero_length(spines, head):
    def collapse(bones):
        bones["spine2.2"].use_connect = False
        bones["spine2.2"].head = bones["spine2.1"].head

    edited(spines, collapse)


def upside_down(spines, head):
    spines.rotation_euler.x = 3.14159265


def much_too_large(spines, head):
    spines.scale = (40, 40, 40)


def misspelt(spines, head):
    spines.data.bones["spine3.0"]["stifness"] = 5.0


def misplaced(spines, head):
    spines.data.bones["ferrule"]["friction"] = 0.2


def negative(spines, head):
    spines.data.bones["spine4.2"]["stiffness"] = -1.0


def slippery(spines, head):
    spines["friction_static"] = 0.1


def two_strips_and_a_half(spines, head):
    head["strips"] = 2.5


def in_millimetres(spines, head):
    """The same brush, modelled larger, turned and moved."""
    place = spines.matrix_world.copy()
    spines.scale, spines.location = (1e-3, 1e-3, 1e-3), (0.2, -0.1, 0.3)
    spines.rotation_euler.z = 1.0
    bpy.context.view_layer.update()
    undo = spines.matrix_world.inverted() @ place
    spines.data.transform(undo)
    head.data.transform(undo)


def as_blender_writes_it(spines, head):
    """With a material, a map, flat faces and a modifier, by the exporter's own defaults."""
    head.data.materials.append(bpy.data.materials.new("Hair"))
    head.data.uv_layers.new()
    head.modifiers.new("Smooth", "SUBSURF").levels = 2


def write_plainly(spines, head, path):
    """Exports everything by the exporter's own defaults, but for the custom properties."""
    bpy.ops.export_scene.gltf(filepath=str(path), export_extras=True)


MODELS = [
    unweighted,
    branching,
    too_many_joints,
    too_many_spines,
    zero_length,
    upside_down,
    much_too_large,
    misspelt,
    misplaced,
    negative,
    slippery,
    two_strips_and_a_half,
    in_millimetres,
    as_blender_writes_it,
]


def exports(head, path):
    """Whether the panel's button exports the model that a mesh belongs to."""
    bpy.context.view_layer.objects.active = head
    try:
        return bpy.ops.maulstick.export(filepath=str(path)) == {"FINISHED"}
    except RuntimeError:
        return False


found = {}
for change in MODELS:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    maulstick_brush.register()
    spines, head = model_round.model()
    bpy.context.view_layer.objects.active = spines
    bpy.ops.maulstick.set_up()
    change(spines, head)
    bpy.context.view_layer.update()
    # What the change added has properties too.
    maulstick_brush.set_up(spines, head)
    name = change.__name__
    found[name] = maulstick_brush.check(spines, head)
    assert exports(head, folder / "button.glb") == (not found[name]), name
    write = write_plainly if change is as_blender_writes_it else maulstick_brush.write
    write(spines, head, folder / f"{name}.glb")
    maulstick_brush.unregister()

# What the exporter leaves behind, the loader cannot see.
spines.pose.bones["spine0.1"]["stiffness"] = 5.0
(left_behind,) = maulstick_brush.check(spines, head)
assert "'stiffness' of 'spine0.1'" in left_behind and "Pose Mode" in left_behind, left_behind
(folder / "found.json").write_text(json.dumps(found))
