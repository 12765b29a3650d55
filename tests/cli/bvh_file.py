"""Biovision files for tests, and where their joints are: an evaluation of its own, in matrices."""

import math
import re

WALKER = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Spine
  {
    OFFSET 0 10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT Neck
    {
      OFFSET 0 40 0
      CHANNELS 3 Xrotation Yrotation Zrotation
      JOINT Head
      {
        OFFSET 0 10 0
        CHANNELS 3 Yrotation Xrotation Zrotation
        End Site
        {
          OFFSET 0 20 0
        }
      }
    }
    JOINT LeftArm
    {
      OFFSET 18 36 0
      CHANNELS 3 Zrotation Yrotation Xrotation
      JOINT LeftForeArm
      {
        OFFSET 28 0 0
        CHANNELS 3 Zrotation Yrotation Xrotation
        JOINT LeftHand
        {
          OFFSET 25 0 0
          CHANNELS 3 Zrotation Yrotation Xrotation
          End Site
          {
            OFFSET 15 0 0
          }
        }
      }
    }
    JOINT RightArm
    {
      OFFSET -18 36 0
      CHANNELS 6 Xposition Yposition Zposition Yrotation Zrotation Xrotation
      JOINT RightForeArm
      {
        OFFSET -28 0 0
        CHANNELS 1 Yrotation
        JOINT RightHand
        {
          OFFSET -25 0 0
          CHANNELS 0
          End Site
          {
            OFFSET -15 0 0
          }
        }
      }
    }
  }
  JOINT LHipJoint
  {
    OFFSET 0 0 0
    CHANNELS 3 Zrotation Yrotation Xrotation
    JOINT LeftUpLeg
    {
      OFFSET 10 -5 0
      CHANNELS 3 Zrotation Yrotation Xrotation
      JOINT LeftLeg
      {
        OFFSET 0 -42 1
        CHANNELS 3 Zrotation Yrotation Xrotation
        JOINT LeftFoot
        {
          OFFSET 0 -42 -1
          CHANNELS 3 Zrotation Yrotation Xrotation
          End Site
          {
            OFFSET 0 -8 15
          }
        }
      }
    }
  }
  JOINT RHipJoint
  {
    OFFSET 0 0 0
    CHANNELS 3 Zrotation Yrotation Xrotation
    JOINT RightUpLeg
    {
      OFFSET -10 -5 0
      CHANNELS 3 Zrotation Yrotation Xrotation
      JOINT RightLeg
      {
        OFFSET 0 -42 1
        CHANNELS 3 Zrotation Yrotation Xrotation
        JOINT RightFoot
        {
          OFFSET 0 -42 -1
          CHANNELS 3 Zrotation Yrotation Xrotation
          End Site
          {
            OFFSET 0 -8 15
          }
        }
      }
    }
  }
}
"""


def walk(frames=12):
    """A character of 170 units that walks; each channel of each joint has a course of its own."""
    channels = re.findall(r"[XYZ](?:position|rotation)", WALKER)
    lines = []
    for frame in range(frames):
        values = []
        for number, channel in enumerate(channels):
            size = 8 if channel.endswith("position") else 170 if number == 3 else 25
            values.append(size * math.sin(0.7 * frame + 1.3 * number) + (95 if number == 1 else 0))
        lines.append(" ".join(f"{value:.6f}" for value in values))
    return WALKER + f"MOTION\nFrames: {frames}\nFrame Time: .0333333\n" + "\n".join(lines) + "\n"


def with_a_knee():
    """The character at rest, with a knee between LeftUpLeg and LeftLeg that alone moves, by 60 degrees."""
    shin = "      JOINT LeftLeg\n"
    knee = "      JOINT Knee\n      {\n        OFFSET 0 -42 1\n        CHANNELS 1 Xrotation\n"
    end = "  JOINT RHipJoint\n"
    tree = WALKER.replace(shin, knee + shin).replace("OFFSET 0 -42 1\n        CHANNELS 3", "OFFSET 0 -1 0\n        CHANNELS 3", 1)
    tree = tree.replace(end, "  }\n" + end)
    before = re.findall(r"[XYZ](?:position|rotation)", tree[:tree.index("JOINT Knee")])
    channels = re.findall(r"[XYZ](?:position|rotation)", tree)
    frames = [[angle if number == len(before) else 95 if number == 1 else 0 for number in range(len(channels))]
              for angle in (0, 60, 30)]
    return tree + "MOTION\nFrames: 3\nFrame Time: .1\n" + "".join(" ".join(map(str, frame)) + "\n" for frame in frames)


def turn(axis, degrees):
    """The 3 x 3 matrix of a turn about X, Y or Z."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}[axis]
    matrix = [[float(row == column) for column in range(3)] for row in range(3)]
    matrix[i][i], matrix[i][j], matrix[j][i], matrix[j][j] = c, -s, s, c
    return matrix


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def moved(matrix, vector):
    return [sum(matrix[i][k] * vector[k] for k in range(3)) for i in range(3)]


class Bvh:
    """Where the joints of a file are, line by line, in the file's units."""

    def __init__(self, text):
        hierarchy, motion = text.split("MOTION")
        self.joints = []  # parent, offset, channels; the ends too
        above = []
        for line in hierarchy.splitlines():
            words = line.split()
            if words[:1] in (["ROOT"], ["JOINT"], ["End"]):
                self.joints.append([above[-1] if above else None, None, []])
            elif words == ["{"]:
                above.append(len(self.joints) - 1)
            elif words == ["}"]:
                above.pop()
            elif words[:1] == ["OFFSET"]:
                self.joints[above[-1]][1] = [float(word) for word in words[1:]]
            elif words[:1] == ["CHANNELS"]:
                self.joints[above[-1]][2] = words[2:]
        lines = motion.strip().splitlines()
        self.step = float(lines[1].split()[-1])
        self.frames = [[float(word) for word in line.split()] for line in lines[2:]]

    def places(self, frame):
        """The places of all joints, in the file's order; frame None: at rest."""
        values = iter(self.frames[frame] if frame is not None else [])
        placed = []
        for parent, offset, channels in self.joints:
            origin, matrix = list(offset), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            for channel in channels if frame is not None else []:
                if channel.endswith("position"):
                    origin["XYZ".index(channel[0])] = next(values)
                else:
                    matrix = times(matrix, turn(channel[0], next(values)))
            if parent is not None:
                above, at = placed[parent]
                origin = [a + b for a, b in zip(at, moved(above, origin))]
                matrix = times(above, matrix)
            placed.append((matrix, origin))
        return [origin for _, origin in placed]
