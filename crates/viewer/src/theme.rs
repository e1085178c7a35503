//! The colours of the picture, light and dark.
//!
//! Colours of meaning come from the colour-blind-safe set of Okabe and Ito (2008) and are the same in every
//! look: control points orange, control curves blue, boundaries vermilion, selection yellow, handles green; only their
//! lightness follows the theme. The background continues the page's own.

use glam::Vec4;

/// A theme. Colours are display values (sRGB), except those of light and matter, which are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Theme {
    /// Background, above and below.
    pub(crate) top: Vec4,
    pub(crate) bottom: Vec4,
    /// Matter of the two sides of a surface, linear.
    pub(crate) front: Vec4,
    pub(crate) back: Vec4,
    /// Light from above and below, linear; `w` of the sky: how much the rim catches of it. On light ground
    /// the rim is dark, so that the outline stands out.
    pub(crate) sky: Vec4,
    pub(crate) ground: Vec4,
    /// Strength of the key and the fill light.
    pub(crate) key: f32,
    pub(crate) fill: f32,
    pub(crate) wire: Vec4,
    pub(crate) grid: Vec4,
    pub(crate) net: Vec4,
    pub(crate) curve: Vec4,
    pub(crate) boundary: Vec4,
    pub(crate) point: Vec4,
    pub(crate) handle: Vec4,
    /// Thin outline that keeps marks apart from what is behind them.
    pub(crate) halo: Vec4,
    pub(crate) selected: Vec4,
    pub(crate) accent: Vec4,
    /// x, y, z.
    pub(crate) axes: [Vec4; 3],
}

impl Theme {
    /// The theme of a look.
    pub(crate) fn new(dark: bool) -> Self {
        if dark { Self::dark() } else { Self::light() }
    }

    fn light() -> Self {
        Self {
            top: display(0xf1_f3_f5, 1.0),
            bottom: display(0xd3_d9_df, 1.0),
            front: linear(0xa3_ab_b6),
            back: linear(0xa8_90_7c),
            sky: Vec4::new(0.36, 0.41, 0.49, -0.10),
            ground: Vec4::new(0.19, 0.17, 0.165, 0.0),
            key: 1.08,
            fill: 0.18,
            wire: display(0x20_2a_36, 0.30),
            grid: display(0x4a_55_62, 0.24),
            net: display(0x4a_55_62, 0.80),
            curve: display(0x00_6b_c2, 1.0),
            boundary: display(0xd5_5e_00, 1.0),
            point: display(0xf0_9a_00, 1.0),
            handle: display(0x06_8a_60, 1.0),
            halo: display(0xff_ff_ff, 0.95),
            selected: display(0xff_d6_00, 1.0),
            accent: display(0x1f_62_c9, 1.0),
            axes: [display(0xc9_48_4e, 1.0), display(0x4c_96_3a, 1.0), display(0x3c_73_cf, 1.0)],
        }
    }

    fn dark() -> Self {
        Self {
            top: display(0x2f_34_3c, 1.0),
            bottom: display(0x17_19_1d, 1.0),
            front: linear(0x88_90_9c),
            back: linear(0x80_69_58),
            sky: Vec4::new(0.20, 0.245, 0.32, 0.60),
            ground: Vec4::new(0.075, 0.07, 0.075, 0.0),
            key: 0.98,
            fill: 0.14,
            wire: display(0x0b_0e_12, 0.42),
            grid: display(0xa9_b6_c6, 0.20),
            net: display(0xa9_b6_c6, 0.75),
            curve: display(0x4f_b0_f0, 1.0),
            boundary: display(0xff_78_30, 1.0),
            point: display(0xff_b0_20, 1.0),
            handle: display(0x1f_c7_98, 1.0),
            halo: display(0x14_17_1b, 0.90),
            selected: display(0xff_e2_3d, 1.0),
            accent: display(0x78_ae_f8, 1.0),
            axes: [display(0xd8_5a_5e, 1.0), display(0x62_aa_4c, 1.0), display(0x4f_86_e0, 1.0)],
        }
    }
}

/// A display colour from its hexadecimal digits.
fn display(rgb: u32, alpha: f32) -> Vec4 {
    let [_, r, g, b] = rgb.to_be_bytes();
    Vec4::new(f32::from(r) / 255.0, f32::from(g) / 255.0, f32::from(b) / 255.0, alpha)
}

/// The linear light of a display colour.
fn linear(rgb: u32) -> Vec4 {
    let part = |c: f32| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    let colour = display(rgb, 1.0);
    Vec4::new(part(colour.x), part(colour.y), part(colour.z), 1.0)
}
