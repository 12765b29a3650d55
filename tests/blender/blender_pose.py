"""Plays clips in Blender, and reads where joints and vertices are, in the file's axes: Y up."""
import bpy

from bendy_rig.axes import Y_UP


def play(clip, frame):
    """clip: the name of an NLA track, or None for the rest pose."""
    for data in [obj for obj in bpy.data.objects] + list(bpy.data.shape_keys):
        animation = data.animation_data
        if animation:
            animation.action = next((track.strips[0].action for track in animation.nla_tracks if track.name == clip), None)
    for armature in bpy.data.armatures:
        armature.pose_position = 'POSE' if clip else 'REST'
    if clip is None:
        for keys in bpy.data.shape_keys:
            for block in keys.key_blocks:
                block.value = 0.0
    whole = int(frame // 1)
    bpy.context.scene.frame_set(whole, subframe=frame - whole)


def skinned_meshes():
    """Names of the objects whose meshes are placed by their bones, wherever the objects are."""
    return {obj.name for obj in bpy.context.scene.objects if any(modifier.type == 'ARMATURE' for modifier in obj.modifiers)}


def joint_places():
    """Name -> places of the bones and objects of that name, without skinned meshes."""
    graph, places, skinned = bpy.context.evaluated_depsgraph_get(), {}, skinned_meshes()
    for obj in bpy.context.scene.objects:
        evaluated = obj.evaluated_get(graph)
        if obj.name not in skinned:
            places.setdefault(obj.name, []).append(tuple((Y_UP @ evaluated.matrix_world).translation))
        for bone in evaluated.pose.bones if evaluated.pose else ():
            places.setdefault(bone.name, []).append(tuple((Y_UP @ evaluated.matrix_world @ bone.matrix).translation))
    return places


def vertex_places():
    """Mesh object's name -> places of its vertices."""
    graph, places = bpy.context.evaluated_depsgraph_get(), {}
    for obj in bpy.context.scene.objects:
        if obj.type == 'MESH':
            evaluated = obj.evaluated_get(graph)
            to_file = Y_UP @ evaluated.matrix_world
            places[obj.name] = [tuple(to_file @ vertex.co) for vertex in evaluated.data.vertices]
    return places
