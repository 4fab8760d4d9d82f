//! The table of forces: each force's element, its attributes, and their meaning.
//!
//! The two readers, the grammar, the writer and the viewers of forces use it. A force without a row does not compile.
use super::{element::Element, model::Force, rule::Rule};
use crate::assignments::ForceKind;
use fosssim_num::vector::Vec2;

/// Provides the attributes of one element to a reader.
pub(super) trait AttributeSource {
    /// The reason why an attribute cannot be used.
    type Error;
    /// Returns the index of an edge that the attribute `name` contains.
    fn edge(&mut self, name: &'static str) -> Result<usize, Self::Error>;
    /// Returns the index of a particle that the attribute `name` contains.
    fn particle(&mut self, name: &'static str) -> Result<usize, Self::Error>;
    /// Returns a number, or the default if there is one. `negative_effect` describes what a negative number does.
    fn number(
        &mut self,
        name: &'static str,
        default: Option<f64>,
        negative_effect: Option<&str>,
    ) -> Result<f64, Self::Error>;
    /// Returns the vector whose components the attributes `x` and `y` contain.
    fn vector(&mut self, x: &'static str, y: &'static str) -> Result<Vec2, Self::Error> {
        let (x, y) = (self.number(x, None, None), self.number(y, None, None));
        Ok(Vec2::new(x?, y?))
    }
}

macro_rules! forces {
    ($($kind:ident $element:literal { $($field:ident: $part:ident($($name:literal),+ $(; $($rule:expr),+)?)),+ })+) => {
        impl ForceKind {
            /// Returns the name of the force's element.
            pub const fn element(self) -> &'static str {
                match self { $(Self::$kind => $element),+ }
            }

            /// Reads the force of an element. All attributes are read before the first error is returned.
            pub(super) fn read<S: AttributeSource>(self, source: &mut S) -> Result<Force, S::Error> {
                match self {
                    $(Self::$kind => {
                        $(let $field = source.$part($($name),+ $(, $($rule),+)?);)+
                        Ok(Force::$kind { $($field: $field?),+ })
                    })+
                }
            }
        }

        impl Force {
            /// Returns the force's kind.
            pub const fn kind(&self) -> ForceKind {
                match self { $(Self::$kind { .. } => ForceKind::$kind),+ }
            }
        }

        /// The elements of forces.
        pub(super) static RULES: &[Rule] = &[$(Rule { name: $element, attributes: &[$($($name),+),+] }),+];

        /// Returns the element of a force.
        pub(super) fn element(force: &Force) -> Element {
            match *force {
                $(Force::$kind { $($field),+ } => Element::new($element)$(.$part($($name),+, $field))+,)+
            }
        }
    };
}

forces! {
    Spring "springforce" {
        edge: edge("edge"),
        stiffness: number("k"; None, Some("the spring pushes where it should pull")),
        rest_length: number("l0"; None, Some("a length cannot be negative")),
        damping: number("b"; Some(0.0), Some("motion is driven instead of damped"))
    }
    SimpleGravity "simplegravity" { acceleration: vector("fx", "fy") }
    Gravitation "gravitationalforce" { first: particle("i"), second: particle("j"), constant: number("G"; None, None) }
    Constant "constantforce" { force: vector("fx", "fy") }
    Drag "dragdamping" { coefficient: number("b"; None, Some("motion is driven instead of damped")) }
    Vortex "vortexforce" {
        first: particle("i"),
        second: particle("j"),
        strength: number("kbs"; None, None),
        coupling: number("kvc"; None, None)
    }
}
