//! How the tools that make and join things do it: choices that stay from one use to the next.

use super::{Around, ToolKind};
use ductile_spec::{CageForm, FillStyle, JoinRibbon};

/// The choices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Sweep and Glue: the other way round than lies nearest. Only for the act under way.
    pub reversed: bool,
    /// Glue: with a band between the rims.
    pub skirt: bool,
    /// Trim: smooth where the surfaces join, instead of a crease.
    pub smooth: bool,
    /// Trim: the surfaces are held to the directions in which they leave the join.
    pub ribbon: bool,
    /// Trim: the angle between the surfaces in degrees, where a ribbon holds it; as they meet while nobody chose.
    pub angle: Option<f64>,
    /// Merge: the rims of the tube stay as control curves.
    pub keep: bool,
    /// Merge: radius of the tube in model units; what suits the model while nobody chose.
    pub radius: Option<f64>,
    /// Cage: which one a click places.
    pub form: CageForm,
    /// Cage: its size in model units; what suits the view while nobody chose.
    pub size: Option<f64>,
    /// How far a face is extruded, in model units; what suits the face while nobody chose.
    pub distance: Option<f64>,
    /// Fill: how loops are filled.
    pub fill: FillStyle,
    /// Displace: how far around.
    pub around: Around,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            reversed: false,
            skirt: true,
            smooth: false,
            ribbon: false,
            angle: None,
            keep: true,
            radius: None,
            form: CageForm::default(),
            size: None,
            distance: None,
            fill: FillStyle::default(),
            around: Around::default(),
        }
    }
}

/// A choice that is on or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toggle {
    /// [`Options::reversed`].
    Reversed,
    /// [`Options::skirt`].
    Skirt,
    /// [`Options::smooth`].
    Smooth,
    /// [`Options::ribbon`].
    Ribbon,
    /// [`Options::keep`].
    Keep,
}

impl Toggle {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Reversed, Self::Skirt, Self::Smooth, Self::Ribbon, Self::Keep];

    /// Its word in the page: `option-skirt` is its button.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Reversed => "reversed",
            Self::Skirt => "skirt",
            Self::Smooth => "smooth",
            Self::Ribbon => "ribbon",
            Self::Keep => "keep",
        }
    }

    /// The choice that a key turns while a tool is in hand.
    #[must_use]
    pub fn of_key(kind: ToolKind, key: &str) -> Option<Self> {
        let toggle = match key {
            "r" if kind == ToolKind::Trim => Self::Ribbon,
            "r" => Self::Reversed,
            "s" if kind == ToolKind::Glue => Self::Skirt,
            "s" => Self::Smooth,
            "k" => Self::Keep,
            _ => return None,
        };
        toggle.serves(kind).then_some(toggle)
    }

    /// Whether a tool has this choice.
    #[must_use]
    pub fn serves(self, kind: ToolKind) -> bool {
        match self {
            Self::Reversed => matches!(kind, ToolKind::Sweep | ToolKind::Glue),
            Self::Skirt => kind == ToolKind::Glue,
            Self::Smooth | Self::Ribbon => kind == ToolKind::Trim,
            Self::Keep => kind == ToolKind::Merge,
        }
    }
}

impl Options {
    /// Whether a choice is on.
    #[must_use]
    pub fn is_on(&self, toggle: Toggle) -> bool {
        match toggle {
            Toggle::Reversed => self.reversed,
            Toggle::Skirt => self.skirt,
            Toggle::Smooth => self.smooth,
            Toggle::Ribbon => self.ribbon,
            Toggle::Keep => self.keep,
        }
    }

    /// How a trim holds both surfaces where it joins them. Joined smoothly they have no angle.
    #[must_use]
    pub fn join_ribbon(&self) -> Option<JoinRibbon> {
        let angle = self.angle.filter(|_| !self.smooth);
        self.ribbon.then(|| angle.map_or(JoinRibbon::AsMet, |angle| JoinRibbon::Angle(angle.to_radians())))
    }

    /// Turns a choice.
    pub fn turn(&mut self, toggle: Toggle) {
        let choice = match toggle {
            Toggle::Reversed => &mut self.reversed,
            Toggle::Skirt => &mut self.skirt,
            Toggle::Smooth => &mut self.smooth,
            Toggle::Ribbon => &mut self.ribbon,
            Toggle::Keep => &mut self.keep,
        };
        *choice = !*choice;
    }
}
