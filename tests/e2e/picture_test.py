"""`semigeo picture`: PNG files that show what the options say. They are decoded here, by the standard library."""

import struct
import unittest
import zlib

import numpy as np

from support import SemigeoTest, boulder, plane, write_ply


def read_png(path):
    """The pixels of an RGB file, (height, width, 3). Source: PNG specification, 2nd edition."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, head = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0]
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    width, height, depth, colour, _, _, interlaced = head
    assert (depth, colour, interlaced) == (8, 2, 0), head
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 3 * width)
    pixels = np.zeros((height + 1, 3 * width + 3), np.int32)
    for y, (kind, row) in enumerate(zip(rows[:, 0], rows[:, 1:]), 1):
        above = pixels[y - 1]
        for x, value in enumerate(row.tolist(), 3):
            left, up, corner = int(pixels[y, x - 3]), int(above[x]), int(above[x - 3])
            if kind == 4:
                guess = min((abs(up - corner), 0, left), (abs(left - corner), 1, up),
                            (abs(left + up - 2 * corner), 2, corner))[2]
            else:
                guess = (0, left, up, (left + up) // 2)[kind]
            pixels[y, x] = value + guess & 255
    return pixels[1:, 3:].reshape(height, width, 3)


class PictureTest(SemigeoTest):
    def setUp(self):
        super().setUp()
        write_ply(self.scans / "a.ply", boulder(3, 1))
        self.run_scans("--levels", "3", "--unit", "mm")
        self.output = self.folder / "a.png"

    def picture(self, *arguments, name="a.ply"):
        printed = self.semigeo("picture", self.dataset(name), "--output", self.output, "--size", "120",
                               *arguments).stdout
        return read_png(self.output), printed

    def coloured(self, pixels):
        """How many pixels are bluish or orange."""
        return int((abs(pixels[:, :, 0] - pixels[:, :, 2]) > 40).sum())

    def test_shows_the_surface_on_white(self):
        pixels, printed = self.picture()
        self.assertEqual(pixels.shape[0], 120)
        self.assertIn(f"{pixels.shape[1]} x 120 pixels, colours from -", printed)
        self.assertTrue((pixels[0, 0] == 255).all())
        self.assertGreater(self.coloured(pixels), 500)

    def test_without_a_field_nothing_is_coloured(self):
        pixels, printed = self.picture("--field", "none")
        self.assertEqual(self.coloured(pixels), 0)
        self.assertGreater((pixels < 200).all(axis=2).sum(), 1000)
        self.assertNotIn("colours", printed)

    def test_fields_views_scales_and_limits_make_other_pictures(self):
        seen = [self.picture(*options)[0].tobytes() for options in (
            (), ("--field", "gaussian"), ("--view", "front"), ("--colours", "thesis"), ("--limit", "0.5"),
            ("--level", "0"), ("--up", "z"), ("--features", "mean"), ("--contours", "all"))]
        self.assertEqual(len(set(seen)), len(seen))

    def test_equal_options_make_equal_bytes(self):
        self.picture("--features", "all")
        first = self.output.read_bytes()
        self.picture("--features", "all")
        self.assertEqual(self.output.read_bytes(), first)

    def test_a_folder_is_no_dataset(self):
        process = self.semigeo("picture", self.archive, "--output", self.output, code=1)
        self.assertIn("is a folder, not a dataset; give one dataset: ", process.stderr)

    def test_the_limit_is_a_curvature_that_colours_can_show(self):
        dataset = self.dataset("a.ply")
        for limit in ("1e-300", "1e300", "inf", "nan", "-1", "x"):
            process = self.semigeo("picture", dataset, "--limit", limit, "--output", self.folder / "p.png", code=2)
            self.assertIn("give a curvature from 1e-30 to 1e30, or 0", process.stderr)
        for limit in ("1e-30", "1e30", "0"):
            self.semigeo("picture", dataset, "--limit", limit, "--output", self.folder / "p.png")

    def test_levels_stand_beside_each_other_with_one_limit(self):
        one, _ = self.picture("--level", "0")
        strip, printed = self.picture("--levels", "0,1,3")
        self.assertGreater(strip.shape[1], one.shape[1] + 150)  # two more panels
        self.assertEqual(printed.count("colours from"), 1)

    def test_an_open_surface_is_seen_from_both_sides(self):
        write_ply(self.scans / "p.ply", plane(12))
        self.run_scans("--levels", "1")
        top, _ = self.picture("--view", "front", "--field", "none", name="p.ply")
        bottom, _ = self.picture("--view", "back", "--field", "none", name="p.ply")
        self.assertGreater(top[50, 50].sum(), bottom[50, 50].sum())
        self.assertLess(bottom[50, 50].sum(), 600)

    def test_what_cannot_be_drawn_is_refused(self):
        for arguments, code, reason in (
                (("--output", "a.jpg"), 2, "give a name that ends in .png"),
                (("--output", "a.png", "--level", "9"), 1, "there are 4 levels"),
                (("--output", "a.png", "--levels", "0,9"), 1, "there are 4 levels"),
                (("--output", "a.png", "--level", "1", "--levels", "2"), 2, "--level"),
                (("--output", "a.png", "--levels", "0,1,2,3", "--size", "8192"), 2, "200 million"),
                (("--output", self.folder / "no" / "a.png"), 1, "no")):
            with self.subTest(arguments=arguments):
                process = self.semigeo("picture", self.dataset("a.ply"), *arguments, code=code, cwd=self.folder)
                self.assertIn(reason, process.stderr)
        self.assertEqual([p.name for p in self.folder.glob("*.png")], [])


if __name__ == "__main__":
    unittest.main()
