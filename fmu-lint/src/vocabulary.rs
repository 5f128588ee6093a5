//! Words with a meaning in the standard, section 2.2.7.

/// Makes an enum of a set of words, with their spelling in the XML.
macro_rules! words {
    ($(#[$about:meta])* $name:ident { $($variant:ident $word:literal),* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $name { $($variant),* }

        impl $name {
            pub const WORDS: &[&str] = &[$($word),*];
            const ALL: &[$name] = &[$($name::$variant),*];

            /// Spelling in the XML.
            pub fn word(self) -> &'static str {
                match self { $($name::$variant => $word),* }
            }

            pub fn read(word: &str) -> Option<Self> {
                let at = Self::WORDS.iter().position(|known| *known == word)?;
                Self::ALL.get(at).copied()
            }
        }
    };
}

words! {
    /// Origin of a variable's value.
    Causality {
        Parameter "parameter", CalculatedParameter "calculatedParameter", Input "input",
        Output "output", Local "local", Independent "independent"
    }
}

words! {
    /// Times at which the value of a variable may change.
    Variability {
        Constant "constant", Fixed "fixed", Tunable "tunable", Discrete "discrete",
        Continuous "continuous"
    }
}

words! {
    /// Initialisation of a variable.
    Initial { Exact "exact", Approx "approx", Calculated "calculated" }
}

words! {
    /// Type of a variable.
    Kind {
        Real "Real", Integer "Integer", Boolean "Boolean", String "String",
        Enumeration "Enumeration"
    }
}

/// Kinds of dependence of an unknown on a known.
pub const DEPENDENCE: &[&str] = &["dependent", "constant", "fixed", "tunable", "discrete"];

impl Kind {
    /// The base type, which has value references of its own: the C functions treat enumerations as integers.
    pub fn base(self) -> Kind {
        if self == Kind::Enumeration { Kind::Integer } else { self }
    }
}
