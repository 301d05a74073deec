//! The functions that expressions may call.

use std::fmt;

use crate::real::Real;

macro_rules! functions {
    ($(#[$meta:meta])* $type:ident: $($variant:ident $name:literal $doc:literal),* $(,)?) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $type {
            $(#[doc = $doc] $variant,)*
        }

        impl $type {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The name in expressions.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            /// The function of this name.
            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|function| function.name() == name)
            }
        }

        impl fmt::Display for $type {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

functions! {
    /// A function of one argument.
    Function:
    Sin "sin" "Sine of an angle in rad.",
    Cos "cos" "Cosine of an angle in rad.",
    Tan "tan" "Tangent of an angle in rad.",
    Asin "asin" "Inverse sine, in rad.",
    Acos "acos" "Inverse cosine, in rad.",
    Atan "atan" "Inverse tangent, in rad.",
    Sinh "sinh" "Hyperbolic sine.",
    Cosh "cosh" "Hyperbolic cosine.",
    Tanh "tanh" "Hyperbolic tangent.",
    Exp "exp" "e to the power of the argument.",
    Log "log" "Natural logarithm; not a number below zero.",
    Sqrt "sqrt" "Square root; not a number below zero.",
    Abs "abs" "Absolute value.",
    Sign "sign" "-1, 0 or 1.",
}

functions! {
    /// A function of two arguments.
    Pair:
    Atan2 "atan2" "Angle of the point (second, first argument), in rad.",
    Min "min" "The smaller one (of any number of arguments).",
    Max "max" "The larger one (of any number of arguments).",
    Pow "pow" "The first to the power of the second: another way to write `^`.",
}

impl Function {
    /// The value for one argument.
    #[inline(always)]
    pub fn of<R: Real>(self, x: R) -> R {
        match self {
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Asin => x.asin(),
            Self::Acos => x.acos(),
            Self::Atan => x.atan(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh => x.tanh(),
            Self::Exp => x.exp(),
            Self::Log => x.ln(),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
            Self::Sign => x.signum(),
        }
    }
}

impl Pair {
    /// The value for two arguments.
    #[inline(always)]
    pub fn of<R: Real>(self, a: R, b: R) -> R {
        match self {
            Self::Atan2 => a.atan2(b),
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Pow => a.powf(b),
        }
    }

    /// Whether more than two arguments are taken, from left to right.
    pub fn takes_many(self) -> bool {
        matches!(self, Self::Min | Self::Max)
    }
}

/// Names of all functions.
pub fn names() -> impl Iterator<Item = &'static str> {
    let one = Function::ALL.iter().map(|function| function.name());
    one.chain(Pair::ALL.iter().map(|pair| pair.name()))
}

/// Whether a name is taken by the language: a function, `pi` or `time`.
pub fn is_reserved(name: &str) -> bool {
    name == "pi" || name == "time" || names().any(|function| function == name)
}
