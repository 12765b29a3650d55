"""A rig of everything that Blender has no setting for, or another one, for the tentacle of examples/: strange_rig() is a rig file."""

HALF = 0.70710678
ALONG = [0.5, 0.5, 0.5, 0.5]        # the frame's X is the bone's Y


def joints():
    """Lists each joint and how Blender represents it."""
    return {
        # both are there, and the ellipse is in the bone's axes
        'seg_00': [{'model': 'euler_box', 'order': 'ZXY', 'scope': 'all_but_ik', 'x': [-10, 20], 'y': [-5, 8], 'z': [None, 15]},
                   {'model': 'swing_twist_ellipse', 'scope': 'ik_only', 'frame': ALONG, 'x': [-8, 12], 'y': [-20, 30], 'z': [-15, 25],
                    'stiffness': [0.25, 0.5, 0.75]}],
        # hinges about the bone's X, Z and an axis between them
        'seg_01': [{'model': 'hinge', 'x': [-30, 45]}],
        'seg_02': [{'model': 'hinge', 'frame': [0, -HALF, 0, HALF], 'x': [-10, 60]}],
        'seg_03': [{'model': 'hinge', 'frame': [0, 0.2, 0, 0.9797959], 'x': [-10, 60]}],
        # a box in a frame that is another order of axes
        'seg_04': [{'model': 'euler_box', 'order': 'XYZ', 'frame': ALONG, 'x': [-10, 20], 'y': [-30, 40], 'z': [-50, 60]}],
        'seg_05': [{'model': 'swing_twist_pyramid', 'frame': ALONG, 'x': [-10, 20], 'y': [-30, 40], 'z': [-50, 60], 'soft_zone': 5}],
        'seg_06': [{'model': 'largest_angle', 'angle': 50, 'preferred': [10, 0, 5]}],
        'seg_07': [{'model': 'locked', 'translation': {'x': [-0.1, 0.2], 'z': [None, 0.05]}}],
        'seg_08': [{'model': 'free', 'stiffness': [1, 0, 0.5]}, {'model': 'swing_twist_ellipse', 'scope': 'ik_only', 'frame': ALONG,
                                                                 'y': [None, 30], 'z': [-20, 20], 'proposed': True}],
        'seg_09': [{'model': 'swing_twist_ellipse', 'frame': [0.1, 0.2, 0.3, 0.9273618], 'x': [-10, 20], 'y': [-30, 40], 'z': [-50, 60]}],
    }


def chains():
    return [
        {'name': 'no target', 'start': 'seg_02', 'effector': 'seg_05', 'pole_vector': [0, 0, 1], 'pole_angle': 20, 'solver': 'two_bone',
         'priority': 3, 'tolerance': 0.001, 'weights': {'seg_03': 0.5}},
        {'name': 'tip beside the bone', 'start': 'seg_05', 'effector': 'seg_08', 'tip_offset': [0.1, 0.05, -0.02], 'target': 'ctl_target',
         'pole': 'ctl_pole', 'solver': 'ccd', 'iterations': 40, 'influence': 0.5, 'stretch': 0.25, 'compress': 0.5},
        {'name': 'turned', 'start': 'seg_07', 'effector': 'seg_09', 'tip_offset': [0, 0.19995935, 0], 'tip_rotation': [0, 0, HALF, HALF],
         'target': 'ctl_target', 'rotation_weight': 0.5, 'position_weight': 0.25, 'solver': 'least_squares', 'extras': {'note': [1, None]}},
        {'name': 'same end', 'start': 'seg_03', 'effector': 'seg_05', 'target': 'ctl_target'},
    ]


def strange_rig():
    return {
        'bendy_rig': 1,
        'complete': True,
        'joints': joints(),
        'chains': chains(),
        'markers': {'Reach': [{'time': 0.3333, 'name': 'grab'}, {'time': 1.01, 'name': 'let go'}, {'time': 1.01, 'name': 'grab'}]},
        'curves': [{'clip': 'Wave', 'name': 'Glow', 'interpolation': 'step', 'times': [0, 0.5, 1.9], 'values': [0, 1, 0]}],
    }
