//! The properties of contacts, zones and steps whose values scenes have to contain.

/// A property of events: its name, and its possible values.
#[derive(Debug, Clone, Copy)]
pub struct Axis {
    /// The name of the property.
    pub name: &'static str,
    /// The names of the possible values, for reports.
    pub values: &'static [&'static str],
}

/// A value of a property: the property's name, and the index of the value.
pub(super) type AxisValue = (&'static str, usize);

/// Declares a property as an enum whose variants are its values.
macro_rules! axis {
    ($name:ident, $title:literal: $($value:ident = $words:literal),+ $(,)?) => {
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(super) enum $name {
            $($value),+
        }

        impl $name {
            pub(super) const AXIS: Axis = Axis { name: $title, values: &[$($words),+] };
        }
    };
}

axis!(DetectionPass, "found in": Continuous = "the pass of continuous-time", First = "the first impulse round",
    Later = "a later impulse round", Zones = "the first pass for zones", Grown = "a later pass for zones");
axis!(ContactTime, "time": Start = "start of the step", Within = "within the step", End = "end of the step");
axis!(Restitution, "COR": Zero = "0", Between = "between", One = "1");
axis!(Integrator, "integrator": Explicit = "explicit", ForwardBackward = "forward-backward", Implicit = "implicit",
    Linearized = "linearized implicit");
axis!(MassRatio, "masses": Equal = "equal", Unequal = "unequal");
axis!(Radii, "radii": Equal = "equal", Unequal = "unequal");
axis!(ContactCount, "contacts of its bodies": Alone = "this one", Several = "several in one pass");
axis!(FixedOfTwo, "fixed": None = "none", First = "the first", Second = "the second", Both = "both");
axis!(FixedOfThree, "fixed": None = "none", Particle = "the particle", First = "the first end", Second = "the second \
    end",
    Ends = "both ends", ParticleAndEnd = "the particle and an end", All = "all");
axis!(FixedOne, "fixed": Free = "no", Fixed = "the particle");
axis!(Place, "place on the edge": First = "near the first end", Inside = "inside", Second = "near the second end");
axis!(Ends, "edge's ends": Next = "j = i + 1", Previous = "j = i - 1", Up = "j > i + 1", Down = "j < i - 1");
axis!(EdgeMotion, "edge's motion": Still = "none", Shifted = "shifted", Turned = "turned or stretched");
axis!(Side, "side": Front = "in front", Behind = "behind");
axis!(Normal, "normal": Unit = "of length 1", Other = "of another length");
axis!(Size, "particles": One = "1", Two = "2", Three = "3", More = "4 or more");
axis!(ZoneAnchor, "held by": Nothing = "nothing", Fixed = "a fixed particle", HalfPlane = "a half-plane",
    Both = "both");
axis!(Motion, "motion": Rests = "rests", Shifts = "shifts only", Turns = "turns");
axis!(ZoneOrigin, "zone is": First = "of the first round", New = "new in a later round", Grown = "grown",
    Same = "as before");
axis!(Position, "place in the list": Only = "the only one", First = "first", Between = "in between", Last = "last");
axis!(ZoneEdge, "edge in it": None = "none", Next = "j = i + 1", Previous = "j = i - 1", Apart = "|j - i| > 1");
axis!(Links, "contacts": One = "one", Several = "several");
axis!(Limit, "maxiters": Zero = "0", One = "1", More = "2 or more");
axis!(Hits, "contacts at first": None = "none", One = "one", Several = "several");
axis!(Forces, "forces": None = "none", Some = "some");
axis!(Penalty, "penalty force": Off = "off", On = "on");
axis!(LoopEnd, "impulses": Nothing = "nothing collides", Within = "end before the limit",
    JustEnough = "the last round finds nothing", RunOut = "the limit is reached", NotAllowed = "the limit is 0");
axis!(ZoneCount, "zones": None = "none", One = "one", Several = "several");
axis!(Rounds, "rounds of zones": None = "none", One = "1", Two = "2", More = "3 or more");
axis!(NoContactReason, "why not": Parting = "they part", BesideFirst = "beside the first end",
    BesideSecond = "beside the second end", Late = "too late", Never = "they never meet");
axis!(Kind, "pair": Particles = "two particles", Edge = "a particle and an edge",
    HalfPlane = "a particle and a half-plane");
axis!(SomeFixed, "fixed": None = "none", Some = "some", All = "all");
