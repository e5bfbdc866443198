"""Models a small round brush in Blender and exports it: `python model_round.py OUT.glb`.

A model to start from, and what the tests drive Blender with.
"""

import math
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
import maulstick_brush

BONE_M = 8e-3
BONES = 3
RADIUS_M = 3e-3
# Height and radius of each ring of the mesh, m.
RINGS = [(0.0, 4e-3), (-6e-3, 5e-3), (-12e-3, 4.5e-3), (-18e-3, 3e-3), (-24e-3, 1e-3)]
AROUND = 12


def armature():
    """One chain in the middle and four around it, carried by a bone in the ferrule."""
    data = bpy.data.armatures.new("Spines")
    spines = bpy.data.objects.new("Spines", data)
    bpy.context.scene.collection.objects.link(spines)
    bpy.context.view_layer.objects.active = spines
    bpy.ops.object.mode_set(mode="EDIT")
    ferrule = data.edit_bones.new("ferrule")
    ferrule.head, ferrule.tail = (0, 0, 4e-3), (0, 0, 1e-3)
    for spine, (x, y) in enumerate([(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)]):
        parent = ferrule
        for i in range(BONES):
            bone = data.edit_bones.new(f"spine{spine}.{i}")
            bone.head = (x * RADIUS_M, y * RADIUS_M, -i * BONE_M)
            bone.tail = (x * RADIUS_M, y * RADIUS_M, -(i + 1) * BONE_M)
            bone.parent, bone.use_connect = parent, i > 0
            parent = bone
    bpy.ops.object.mode_set(mode="OBJECT")
    return spines


def mesh(spines):
    """A tapered tube that is closed below, tied to the armature."""
    turns = [2 * math.pi * i / AROUND for i in range(AROUND)]
    vertices = [(r * math.cos(t), r * math.sin(t), z) for z, r in RINGS for t in turns]
    faces = []
    for ring in range(1, len(RINGS)):
        for i in range(AROUND):
            j = (i + 1) % AROUND
            above, below = (ring - 1) * AROUND, ring * AROUND
            faces.append((above + j, above + i, below + i, below + j))
    faces.append([(len(RINGS) - 1) * AROUND + i for i in reversed(range(AROUND))])
    data = bpy.data.meshes.new("Head")
    data.from_pydata(vertices, [], faces)
    head = bpy.data.objects.new("Head", data)
    bpy.context.scene.collection.objects.link(head)
    head.parent = spines
    head.modifiers.new("Spines", "ARMATURE").object = spines
    weigh(head, spines)
    return head


def weigh(head, spines):
    """Ties each vertex to bones by the inverse fourth power of its distance."""
    bones = [bone for bone in spines.data.bones if bone.name != "ferrule"]
    groups = {bone.name: head.vertex_groups.new(name=bone.name) for bone in bones}
    for vertex in head.data.vertices:
        middles = {bone.name: (bone.head_local + bone.tail_local) / 2 for bone in bones}
        near = sorted(bones, key=lambda bone: (middles[bone.name] - vertex.co).length)[:4]
        shares = [(middles[bone.name] - vertex.co).length ** -4 for bone in near]
        for bone, share in zip(near, shares):
            groups[bone.name].add([vertex.index], share / sum(shares), "REPLACE")


def model():
    """The armature and the mesh."""
    spines = armature()
    return spines, mesh(spines)


def main(path):
    """Models, sets up, checks and exports the brush."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    spines, head = model()
    maulstick_brush.set_up(spines, head)
    spines["friction"] = 0.3
    spines["kind"] = "modelled"
    for bone in spines.data.bones:
        if bone.name.startswith("spine0"):
            bone["stiffness"] = 40.0
    maulstick_brush.export(spines, head, path)


if __name__ == "__main__":
    main(sys.argv[1])
