"""How far two pictures, as read_png gives them, are apart."""


def rgb(picture):
    width, height, channels, data = picture
    if channels == 3:
        return data
    out = bytearray(3 * width * height)
    for channel in range(3):
        out[channel::3] = data[channel::channels]
    return bytes(out)


class Difference:
    """What two pictures show otherwise, of the pixels that are not `background` in both; numbers from 0 to 255.

    mean: the mean difference of a channel. most: the 99th percentile over the pixels of how far a channel is from what the
    other picture has there and right beside it; edges, and details smaller than a pixel, which each program samples in its own
    way, do not count in it. elsewhere: the pixels where that is more than `tolerance`, and which have no background beside them
    in either picture."""

    def __init__(self, first, second, background, tolerance=2):
        assert first[:2] == second[:2], (first[:2], second[:2])
        self.width, self.height = first[:2]
        a, b = rgb(first), rgb(second)
        apart = [abs(x - y) for x, y in zip(a, b)]
        drawn = []
        self.elsewhere = 0
        for pixel in range(self.width * self.height):
            at = 3 * pixel
            if a[at:at + 3] == b[at:at + 3] == background:
                continue
            far = max(apart[at:at + 3])
            if far > 1:
                far = max(self.outside(a, b, pixel), self.outside(b, a, pixel))
            if far > tolerance and not any(data[3 * near:3 * near + 3] == background
                                           for data in (a, b) for near in self.around(pixel)):
                self.elsewhere += 1
            drawn.append(far)
        self.drawn = len(drawn)
        self.mean = sum(apart) / (3 * max(1, len(drawn)))
        self.most = sorted(drawn)[len(drawn) * 99 // 100] if drawn else 0

    def outside(self, a, b, pixel):
        """How far the pixel in a is from the range of the 3 x 3 pixels around it in b."""
        around = self.around(pixel)
        worst = 0
        for channel in range(3):
            values = [b[3 * near + channel] for near in around]
            value = a[3 * pixel + channel]
            worst = max(worst, value - max(values), min(values) - value)
        return worst

    def around(self, pixel):
        """The 3 x 3 pixels, fewer at the border."""
        y, x = divmod(pixel, self.width)
        return [v * self.width + u for v in range(max(0, y - 1), min(self.height, y + 2))
                for u in range(max(0, x - 1), min(self.width, x + 2))]

    def __str__(self):
        return f"{self.drawn:6} pixels: mean {self.mean:.3f}, 99 of 100 within {self.most}, {self.elsewhere} elsewhere"


def side_by_side(*pictures):
    """One picture of several of the same size, and of eight times the first two's difference."""
    width, height = pictures[0][:2]
    parts = [rgb(picture) for picture in pictures]
    parts.append(bytes(min(255, 8 * abs(x - y)) for x, y in zip(parts[0], parts[1])))
    rows = [part[3 * width * y:3 * width * (y + 1)] for y in range(height) for part in parts]
    return width * len(parts), height, 3, b"".join(rows)
