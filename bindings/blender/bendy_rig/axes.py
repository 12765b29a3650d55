"""Blender's Z-up axes and the file's.

A bone's own axes stay as they are, because the exporter rotates only what is above the bones. So limits in a bone's space stay
unchanged, while limits about the armature's or the world's axes are converted.
"""
from mathutils import Matrix, Quaternion

Y_UP = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))       # x, y, z -> x, z, -y


class FileAxes:
    """The conversion from Blender's axes to the file's; y_up is the exporter's option."""

    def __init__(self, y_up):
        self.y_up = y_up
        self.matrix = Y_UP if y_up else Matrix.Identity(4)

    def ranges(self, ranges):
        """Ranges of angles or of positions: axis x, y, z -> [low, high], None where one is free."""
        if not self.y_up:
            return ranges
        turned = {'x': ranges.get('x'), 'y': ranges.get('z'), 'z': opposite(ranges.get('y'))}
        return {axis: limits for axis, limits in turned.items() if limits}

    def order(self, order):
        return order.translate(str.maketrans('YZ', 'ZY')) if self.y_up else order

    def zero(self):
        """The orientation in the file of a bone that has none in Blender."""
        return self.matrix.to_quaternion() if self.y_up else Quaternion()


def opposite(limits):
    if not limits:
        return None
    low, high = limits
    return [None if high is None else -high, None if low is None else -low]
