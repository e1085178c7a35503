//! The legend of a look: what its colours and lines mean, and handles to change that.

use super::dom;
use super::menu;
use super::page::{Page, act};
use crate::look::Slices;
use crate::number;
use crate::{Shading, mean_range};
use web_sys::{Event, HtmlInputElement};

/// The fields of index.html in which something is typed.
pub(crate) const FIELDS: [&str; 3] = ["legend-low", "legend-high", "slice-distance"];

/// Steps of a slider of index.html.
const STEPS: f32 = 1000.0;
/// Where the handles stand on the bar after fitting, as a part of its length from either end.
const INSET: f32 = 0.2;
/// Colours of the ramp, and contours across the model after fitting.
const COLOURS: u8 = 5;
const CONTOURS: f32 = 30.0;

/// How the legend stands.
#[derive(Debug)]
pub(crate) struct Legend {
    /// Nobody has chosen the ends: they follow the shape whenever it rests.
    is_fitted: bool,
    /// The values at the ends of the bar, of which the range is a part.
    bar: [f32; 2],
}

impl Default for Legend {
    fn default() -> Self {
        Self { is_fitted: true, bar: [-1.0, 1.0] }
    }
}

/// Listens to the handles.
pub(crate) fn listen() {
    for (end, id) in ["range-low", "range-high"].into_iter().enumerate() {
        on_slider(id, move |page, place| page.slide_end(end, place / STEPS));
    }
    on_slider("bands", |page, bands| page.settings.look.bands = bands);
    menu::fill("slices", Slices::ALL.map(Slices::label), |place| {
        let chosen = place.and_then(|place| Slices::ALL.get(place).copied()).unwrap_or_default();
        act(move |page| {
            page.settings.look.slices = chosen;
            page.show_legend();
            page.redraw();
        });
    });
}

/// Takes every place of a slider while it is moved.
fn on_slider(id: &str, moved: impl Fn(&mut Page, f32) + Copy + 'static) {
    let slider: HtmlInputElement = dom::element_as(id);
    let own = slider.clone();
    dom::listen(&slider, "input", move |_: Event| {
        let Ok(place) = own.value().parse::<f32>() else { return };
        act(move |page| {
            moved(page, place);
            page.show_legend();
            page.redraw();
        });
    });
}

impl Page {
    /// Chooses how surfaces are coloured.
    pub(crate) fn choose_shading(&mut self, shading: Shading) {
        self.settings.look.shading = shading;
        self.keep_settings();
        self.fit_legend();
        self.apply_settings();
    }

    /// Lets the ends follow the shape again.
    pub(crate) fn fit_legend(&mut self) {
        self.legend.is_fitted = true;
        self.refit_legend();
        self.show_legend();
        self.redraw();
    }

    /// Fits the ends to the shape, unless the designer has chosen them.
    pub(crate) fn refit_legend(&mut self) {
        if !self.legend.is_fitted {
            return;
        }
        match self.settings.look.shading {
            Shading::Mean => {
                let Some([low, high]) = mean_range(&self.scene) else { return };
                let room = (high - low) * INSET / (1.0 - 2.0 * INSET);
                self.legend.bar = [low - room, high + room];
                self.settings.look.range = [low, high];
            }
            Shading::Contours => {
                let Some((_, radius)) = self.scene.bounds() else { return };
                let distance = f64::from(2.0 * radius / CONTOURS);
                // One digit: a distance that one can say.
                let short: f32 = format!("{distance:.0e}").parse().unwrap_or(1.0);
                self.settings.look.distance = short.max(f32::MIN_POSITIVE);
            }
            Shading::Shaded | Shading::Isophotes => {}
        }
        self.show_legend();
    }

    fn slide_end(&mut self, end: usize, part: f32) {
        let [first, last] = self.legend.bar;
        let value = first + (last - first) * part;
        let range = &mut self.settings.look.range;
        range[end] = value;
        // One handle pushes the other.
        range[1 - end] = if end == 0 { range[1].max(value) } else { range[0].min(value) };
        self.legend.is_fitted = false;
    }

    /// Shows the legend of the look, and its numbers.
    pub(crate) fn show_legend(&self) {
        let look = &self.settings.look;
        let title = match look.shading {
            Shading::Shaded => "",
            Shading::Isophotes => "Isophotes",
            Shading::Contours => "Contours",
            Shading::Mean => "Mean curvature",
        };
        dom::show(&dom::element("legend"), look.shading != Shading::Shaded && look.surface);
        dom::text(&dom::element("legend-title"), title);
        dom::show(&dom::element("legend-mean"), look.shading == Shading::Mean);
        dom::show(&dom::element("legend-bands"), look.shading == Shading::Isophotes);
        dom::show(&dom::element("legend-contours"), look.shading == Shading::Contours);
        dom::show(&dom::element("legend-fit"), look.shading != Shading::Isophotes);
        let [first, last] = self.legend.bar;
        let parts = look.range.map(|value| ((value - first) / (last - first)).clamp(0.0, 1.0));
        for (id, part) in ["range-low", "range-high"].into_iter().zip(parts) {
            set_slider(id, part * STEPS);
        }
        set_slider("bands", look.bands);
        let ramp = dom::element("ramp");
        for k in 0..COLOURS {
            let share = f32::from(k) / f32::from(COLOURS - 1);
            let place = 100.0 * (parts[0] + (parts[1] - parts[0]) * share);
            let _ = ramp.style().set_property(&format!("--at-{k}"), &format!("{place:.2}%"));
        }
        menu::show("slices", Slices::ALL.iter().position(|slices| *slices == look.slices), None);
        for id in FIELDS {
            self.fill_field(&dom::element_as(id), false);
        }
    }

    /// What a field of the legend shows.
    pub(crate) fn legend_text(&self, field: &str) -> String {
        let look = &self.settings.look;
        let value = match field {
            "legend-low" => look.range[0],
            "legend-high" => look.range[1],
            _ => look.distance,
        };
        // Four digits: more cannot be seen in a colour.
        number::show(format!("{value:.3e}").parse().unwrap_or(f64::from(value)))
    }

    /// Takes what was typed; says what is wrong with it.
    pub(crate) fn typed_legend(&mut self, field: &str, text: &str) -> Option<String> {
        if text == self.legend_text(field) {
            return None;
        }
        let value = match number::parse(text) {
            Ok(value) => narrow(value),
            Err(error) => return Some(error.to_string()),
        };
        let look = &mut self.settings.look;
        match field {
            "legend-low" if value >= look.range[1] => {
                return Some("The lower end must be below the upper one.".to_owned());
            }
            "legend-high" if value <= look.range[0] => {
                return Some("The upper end must be above the lower one.".to_owned());
            }
            "legend-low" => look.range[0] = value,
            "legend-high" => look.range[1] = value,
            _ if value <= 0.0 => return Some("A distance is above 0.".to_owned()),
            _ => look.distance = value,
        }
        self.legend.is_fitted = false;
        let [low, high] = look.range;
        let [first, last] = self.legend.bar;
        self.legend.bar = [first.min(low), last.max(high)];
        self.show_legend();
        self.redraw();
        None
    }
}

#[expect(clippy::cast_possible_truncation, reason = "colours are made of f32")]
fn narrow(value: f64) -> f32 {
    (value as f32).clamp(f32::MIN, f32::MAX)
}

fn set_slider(id: &str, place: f32) {
    let slider: HtmlInputElement = dom::element_as(id);
    let value = format!("{place:.0}");
    if slider.value() != value {
        slider.set_value(&value);
    }
}
