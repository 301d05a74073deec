//! The chain rule of functions of one number, for every number that carries slopes.

/// Methods of [`Real`](super::Real) for a number with a `value: $inner`, a method
/// `chain(value, slope)` and a constructor `fixed(value)`. `or_zero(at, yes)` has to be in scope:
/// `yes` where `at` is positive and 0 elsewhere, where a slope would be infinite.
macro_rules! chain_rules {
    ($inner:ty) => {
        #[inline(always)]
        fn sin(self) -> Self {
            self.chain(self.value.sin(), self.value.cos())
        }
        #[inline(always)]
        fn cos(self) -> Self {
            self.chain(self.value.cos(), -self.value.sin())
        }
        #[inline(always)]
        fn tan(self) -> Self {
            let t = self.value.tan();
            self.chain(t, t * t + 1.0)
        }
        #[inline(always)]
        fn asin(self) -> Self {
            let rest = -(self.value * self.value) + 1.0;
            self.chain(self.value.asin(), or_zero(rest, <$inner>::constant(1.0) / rest.sqrt()))
        }
        #[inline(always)]
        fn acos(self) -> Self {
            let rest = -(self.value * self.value) + 1.0;
            self.chain(self.value.acos(), or_zero(rest, -(<$inner>::constant(1.0) / rest.sqrt())))
        }
        #[inline(always)]
        fn atan(self) -> Self {
            self.chain(self.value.atan(), <$inner>::constant(1.0) / (self.value * self.value + 1.0))
        }
        #[inline(always)]
        fn sinh(self) -> Self {
            self.chain(self.value.sinh(), self.value.cosh())
        }
        #[inline(always)]
        fn cosh(self) -> Self {
            self.chain(self.value.cosh(), self.value.sinh())
        }
        #[inline(always)]
        fn tanh(self) -> Self {
            let t = self.value.tanh();
            self.chain(t, -(t * t) + 1.0)
        }
        #[inline(always)]
        fn exp(self) -> Self {
            let e = self.value.exp();
            self.chain(e, e)
        }
        #[inline(always)]
        fn ln(self) -> Self {
            self.chain(
                self.value.ln(),
                or_zero(self.value.abs(), <$inner>::constant(1.0) / self.value),
            )
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            let root = self.value.sqrt();
            self.chain(root, or_zero(root, <$inner>::constant(0.5) / root))
        }
        #[inline(always)]
        fn abs(self) -> Self {
            self.chain(self.value.abs(), self.value.signum())
        }
        #[inline(always)]
        fn signum(self) -> Self {
            Self::fixed(self.value.signum())
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            -((-self).max(-other))
        }
    };
}

pub(super) use chain_rules;
