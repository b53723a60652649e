"""shape_contacts runs each method, gives equal runs equal hashes, and finds Drape's contacts without penetration.

Usage: shape_contacts_test.py FOLDER_OF_PROGRAMS
"""
import unittest

from programs import ProgramTest


class ShapeContacts(ProgramTest):
    def test_drape_keeps_cloth_outside(self):
        arguments = ["--scene", "box", "--scene", "plane", "--steps", "60"]
        rows = self.quick("shape_contacts", *arguments)
        again = self.quick("shape_contacts", *arguments)
        self.assertEqual([row["method"] for row in rows], ["drape", "bullet_contacts", "stock"] * 2)
        self.assertEqual([row["hash"] for row in rows], [row["hash"] for row in again])
        for row in rows:
            if row["method"] == "drape":
                self.assertEqual(row["intersecting_max"], "0")

    def test_unknown_names_are_refused(self):
        self.refused("shape_contacts", ["--scene", "bal"], "did you mean ball?")
        self.refused("shape_contacts", ["--method", "stok"], "did you mean stock?")


if __name__ == "__main__":
    unittest.main()
