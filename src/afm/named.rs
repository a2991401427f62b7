//! Closed enums whose variants are chosen by name in a study file.

/// Declares a fieldless enum together with `ALL`, `name` and `from_name`, so that the three cannot
/// drift apart.
macro_rules! named {
    ($(#[$meta:meta])* pub enum $type:ident { $($(#[$variant_meta:meta])* $variant:ident = $name:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $type { $($(#[$variant_meta])* $variant,)+ }

        impl $type {
            /// Every variant, in the order of declaration.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The name by which a study file chooses this variant.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }

            /// The variant of that name, if there is one. The inverse of [`name`](Self::name).
            pub fn from_name(name: &str) -> Option<Self> {
                match name { $($name => Some(Self::$variant),)+ _ => None }
            }
        }

        impl $crate::names::Named for $type {
            const CHOICES: &'static [(&'static str, Self)] = &[$(($name, Self::$variant)),+];
        }
    };
}

pub(crate) use named;

#[cfg(test)]
mod tests {
    use crate::afm::{ContactTheory, Fidelity, Flag, FrictionLaw, LuGreParameters, Torsion};

    #[test]
    fn names_are_what_study_files_say() {
        let friction: Vec<_> = FrictionLaw::ALL.iter().map(|law| law.name()).collect();
        assert_eq!(friction, ["coulomb", "hk", "lugre", "dahl", "stribeck", "armstrong", "lemaitre-carlson"]);
        let contact: Vec<_> = ContactTheory::ALL.iter().map(|theory| theory.name()).collect();
        assert_eq!(contact, ["hertz", "jkr", "dmt", "maugis-dugdale", "cos", "auto"]);
        let fidelity: Vec<_> = Fidelity::ALL.iter().map(|rung| rung.name()).collect();
        assert_eq!(fidelity, ["closed-form", "quasi-static", "dynamic", "fixed-step", "auto"]);
        let lugre: Vec<_> = LuGreParameters::ALL.iter().map(|source| source.name()).collect();
        assert_eq!(lugre, ["frozen", "contact"]);
        let torsion: Vec<_> = Torsion::ALL.iter().map(|formula| formula.name()).collect();
        assert_eq!(torsion, ["thin-strip", "rectangle"]);
    }

    #[test]
    fn from_name_inverts_name_and_refuses_the_rest() {
        for &law in FrictionLaw::ALL {
            assert_eq!(FrictionLaw::from_name(law.name()), Some(law));
        }
        for &flag in Flag::ALL {
            assert_eq!(Flag::from_name(flag.name()), Some(flag));
        }
        for name in ["", "Coulomb", "coulomb ", "stick"] {
            assert_eq!(FrictionLaw::from_name(name), None);
        }
    }
}
