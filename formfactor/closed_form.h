#pragma once

namespace patchlight {

/// Form factors of the reference configurations, from elementary functions. All lengths in one unit, any unit; the
/// results are fractions in [0, 1] and good to about 1e-15. Formulas of Howell's catalogue of configuration factors;
/// all throw std::invalid_argument unless every length is positive and finite.

/// From one a × b rectangle to the equal one right opposite at distance c. Howell C-11, X = a/c, Y = b/c:
/// F = 2/(πXY) { ln √((1+X²)(1+Y²)/(1+X²+Y²)) + X√(1+Y²) atan(X/√(1+Y²)) + Y√(1+X²) atan(Y/√(1+X²))
///     − X atan X − Y atan Y }.
/// Where a side is short beside c the braces cancel, and the same factor is taken from one of its integrals:
/// F = 2/(πX) ∫₀^X (X−u) atan(Y/√(1+u²)) (1+u²)^(−3/2) du, good to about 1e-15 of itself.
double parallel_rectangles(double a, double b, double c);

/// From the l × w rectangle to the l × h rectangle perpendicular to it that shares the edge of length l.
/// Howell C-14, W = w/l, H = h/l:
/// F = 1/(πW) { W atan(1/W) + H atan(1/H) − √(H²+W²) atan(1/√(H²+W²)) + ¼ ln[A B^(W²) C^(H²)] },
/// A = (1+W²)(1+H²)/(1+W²+H²), B = W²(1+W²+H²)/((1+W²)(W²+H²)), C = H²(1+H²+W²)/((1+H²)(H²+W²)).
double perpendicular_rectangles(double l, double w, double h);

/// From the disc of radius r1 to the disc of radius r2 on the same axis at distance h. Howell C-41, q = r2/r1,
/// S = 1 + q² + (h/r1)²: F = ½ (S − √(S² − 4q²)), taken as 2q²/(S + √(S² − 4q²)), which does not cancel.
double coaxial_discs(double r1, double r2, double h);

}  // namespace patchlight
