// Small dense matrices for fits: Householder's QR and what follows from its triangle.
#pragma once

#include <cstddef>
#include <vector>

namespace framesim {

using Column = std::vector<double>;
using Matrix = std::vector<Column>;  // by columns, all of one length

double length_of(const Column& column);

// R of the QR decomposition of `columns` (at least as many rows as columns), r[j][i] its row i in column j; `rhs`, if
// not
// null, is replaced by its rotation, whose first entries belong to R.
Matrix triangle_of(Matrix columns, Column* rhs);

// x of R x = rhs; a pivot of 0 gives 0.
Column solve_triangle(const Matrix& r, const Column& rhs);

// The inverse of R, whose pivots are not 0.
Matrix inverse_of_triangle(const Matrix& r);

// The least singular value of R and its direction, by inverse iteration.
struct LeastDirection {
  double value = 0;
  Column direction;  // length 1
};
LeastDirection least_direction(Matrix r);

}  // namespace framesim
