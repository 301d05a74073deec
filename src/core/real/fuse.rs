//! Products that are added in one step, rounded once (fused multiply-add, IEEE 754-2008).

use super::Real;

/// A number that multiplies and adds in one step.
pub trait Fuse: Real {
    /// self * b + c
    fn fma(self, b: Self, c: Self) -> Self;
    /// self * b - c
    fn fms(self, b: Self, c: Self) -> Self;
    /// c - self * b
    fn fnma(self, b: Self, c: Self) -> Self;
}
