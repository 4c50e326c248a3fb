"""Contact that ends at a corner under an unbounded pressure, 1/sqrt(x): adapted quadratic displacements have
the order that smooth solutions have, and the true error is below what is asked."""
import unittest

import numpy as np

from study_support import STUDIES, StudyTest

ACCURACIES = [0.05, 0.02, 0.01, 5e-3, 2e-3]
MOST = 7000  # unknowns for an error of 1 %


class ContactEdge(StudyTest):
    def test_order_one_in_the_unknowns(self):
        text = (STUDIES / "edge.toml").read_text()
        text = text[:text.rindex("accuracy =")] + f"accuracy = {ACCURACIES}\n"
        self.path.write_text(text.replace("../edge.toml", f"{STUDIES.parent}/edge.toml"))
        self.study()
        rows = self.rows()
        unknowns, errors = (np.array([float(row[key]) for row in rows]) for key in ("dofs", "error energy"))
        order = np.polyfit(np.log(unknowns), np.log(errors), 1)[0]
        takes = np.exp(np.interp(-np.log(0.01), -np.log(errors), np.log(unknowns)))
        print(f"unknowns {unknowns}, errors {errors}, order {order:.2f}, for 1 % {takes:.0f}")
        self.assertAlmostEqual(order, -1, delta=0.1)
        self.assertLessEqual(takes, MOST)
        self.assertTrue((errors < ACCURACIES).all())
        self.assertTrue((errors > np.array(ACCURACIES) / 2.5).all(), "more was done than asked")


if __name__ == "__main__":
    unittest.main()
