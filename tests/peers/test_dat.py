"""The reader of `.dat` tables, and the deviation."""

import pytest

from peers import dat

TEXT = """
 displacements (vx,vy,vz) for set NALL and time  0.5000000E+00

         1  0.000000E+00  0.000000E+00  1.000000E-03
         2  0.000000E+00 -4.000000E-03  0.000000E+00

 stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set EALL and time  0.1000000E+01

         1   1 -1.0E+00 -2.0E+00 -4.000000E+00  0.000000E+00  0.000000E+00  0.000000E+00
         1   2 -1.0E+00 -2.0E+00 -8.000000E+00  0.000000E+00  0.000000E+00  0.000000E+00

 total internal energy for set EALL and time  0.1000000E+01

        2.285724E-04
"""


def test_blocks_have_title_time_and_rows():
    displacements, stresses = dat.blocks(TEXT)
    assert (displacements.what, displacements.name, displacements.time) == ("displacements", "NALL", 0.5)
    assert displacements.rows[(2,)] == [0.0, -4e-3, 0.0]
    assert stresses.rows[(1, 2)][2] == -8.0
    assert stresses.largest() == 8.0


def test_deviation_is_relative_to_the_largest_number_of_the_block():
    block = dat.blocks(TEXT)[0]
    assert dat.deviation(block, {(1,): [0.0, 0.0, 1e-3], (2,): [0.0, -4e-3, 1e-5], (3,): [9.0, 9.0, 9.0]}) == 2.5e-3


def test_a_node_without_an_answer_is_an_error():
    with pytest.raises(KeyError, match="no values"):
        dat.deviation(dat.blocks(TEXT)[0], {(1,): [0.0, 0.0, 0.0]})
