// What sharing one resolution loses where curves cost set-up: a bound that holds whatever money they are given.
//
// Curve i has benefit b_i sqrt(x_i) and cost c_i(x_i) = min(m_i x_i, s_i + r_i x_i), m_i = s_i/k_i + r_i, its first and
// its second branch (curve_variable.h). Apart, for money M, n curves have at most (weak duality)
//   U(M) = min over L >= 0 of L M + sum u_i(L),  u_i(L) = max over x in [0,1] of b_i sqrt(x) - L c_i(x).
// Shared, they are one curve of B = sum b_i, S = sum s_i, R = sum r_i and the least knee K, whose worth u(L) is defined
// alike. Where many variables compete for money, an ascent along falling slopes has the concave hull of each:
// V(M) = min over L of L M + u(L).
//
// Wanted: V(M) >= (1 - theta) U(M) for every M. Concave functions are ordered as their conjugates are, and that of
// (1 - theta) U at L is sum u_i with b_i replaced by g_i = (1 - theta) b_i. So the loss is at most theta if and only if
//   sum u_i(L; g_i) <= u(L) for every L > 0.                                                                        (1)
//
// It is enough to look at one L. Multiplied by L, with p = L^2, the shared curve is worth
//   L u = max(A, B^2/(4R) - p S),  A = K B^2 / (4 (S + K R)),
// where B > 2 L R (x = 1) with L B - p (S + R) for the second. Let l be where it leaves A, the slope of its jump. For
// curve i let
//   d_i = max(k_i g_i^2 / (4 (s_i + k_i r_i)),  the most that L times its second branch is worth at any L >= l).
//  - L >= l: the left of (1), times L, is at most sum d_i, as L times a first branch is constant; the right A.
//  - L < l, B <= 2 L R: for smaller p the right grows by S a unit, the left by at most sum s_i = S: L times a
//    second branch has slope -s_i in p, at x = 1 g/(2L) - c_i > r_i - c_i = -s_i; a first one 0.
//  - L < l, B > 2 L R: u = B - L (S + R) is linear in L, the left convex: (1) holds between two L if at both, and at
//    L = 0 it reads (1 - theta) B <= B.
// Hence sum d_i <= A suffices; where no curve is at x = 1 at l it is necessary, too. Without set-up it reads
// (1 - theta)^2 sum b_i^2/c_i <= B^2/(S + R).
//
// Variables that each keep 1 - theta keep it together, for every budget: for all together U and V are the best sums over
// ways to share money. V counts a part of the last jump where that does not fit: one variable at a time. A bundle's
// is then split, and what is missing is a part of a single curve's jump, or what its children lose by starting alike.
#pragma once

#include "policies/gradient/node_sums.h"

namespace framesim {

// Where a shared variable jumps: the benefit over cost l of the jump, and A.
struct SharedJump {
  double slope = 0;
  double worth = 0;
};

// Of a sum with set-up > 0; a knee above 1 counts as 1.
SharedJump shared_jump(const NodeSum& sum);

// d_i of one curve that may lose `theta` of its benefit, at a jump of slope l >= 0.
double most_worth(const NodeSum& curve, double theta, double slope);

}  // namespace framesim
