//! The graphics device and the canvas it draws on.
//!
//! A device can be lost at any time (driver reset, laptop asleep). The renderer then tells once, by the
//! callback it was made with; the page drops it and makes another one from the [`Scene`], by the same calls
//! as at the start.

use crate::camera::Camera;
use crate::look::{Highlight, Look};
use crate::painter::Painter;
use crate::scene::Scene;
use wgpu::{
    Adapter, CompositeAlphaMode, CurrentSurfaceTexture, DeviceDescriptor, DeviceType, Instance,
    InstanceDescriptor, PowerPreference, PresentMode, RequestAdapterOptions, Surface, SurfaceConfiguration,
    SurfaceTarget, TextureFormat, TextureUsages, TextureViewDescriptor,
};

/// Samples of a pixel where the device can afford it.
const SAMPLES: u32 = 4;

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// The browser has no WebGPU, or it is switched off. Another browser helps.
    #[error(
        "This browser offers no WebGPU, which the picture needs. Current versions of Chrome, Edge, Safari and Firefox have it; it may have to be switched on."
    )]
    NoWebGpu,
    /// The browser has WebGPU but refused a device. Closing other pages may help.
    #[error("The graphics device could not be opened: {0}")]
    NoDevice(String),
    /// The canvas gives no texture at the moment; the next picture may succeed.
    #[error("The canvas is not ready")]
    NotReady,
    /// The canvas or the device was lost: the renderer must be made anew.
    #[error("The graphics device was lost")]
    Lost,
}

/// Draws scenes on a canvas.
#[derive(Debug)]
pub struct Renderer {
    surface: Surface<'static>,
    config: SurfaceConfiguration,
    painter: Painter,
    samples: u32,
    adapter_name: String,
    /// The canvas has been given the size that `config` says.
    is_configured: bool,
}

impl Renderer {
    /// Draws on a canvas of the page.
    ///
    /// `on_lost` is called once, later, if the device is lost, with the reason that the browser gives.
    ///
    /// # Errors
    ///
    /// [`GpuError::NoWebGpu`] or [`GpuError::NoDevice`].
    #[cfg(target_arch = "wasm32")]
    pub async fn new_on_canvas(
        canvas: web_sys::HtmlCanvasElement,
        on_lost: impl Fn(String) + 'static,
    ) -> Result<Self, GpuError> {
        if !wgpu::util::is_browser_webgpu_supported().await {
            return Err(GpuError::NoWebGpu);
        }
        let size = [canvas.width(), canvas.height()];
        let loss = crate::loss::Loss::default();
        let renderer = Self::new(SurfaceTarget::Canvas(canvas), size, &loss).await?;
        wasm_bindgen_futures::spawn_local(async move { on_lost(loss.await) });
        Ok(renderer)
    }

    /// Draws on any target.
    #[cfg_attr(not(target_arch = "wasm32"), expect(dead_code, reason = "the canvas is the only target yet"))]
    async fn new(
        target: SurfaceTarget<'static>,
        size: [u32; 2],
        loss: &crate::loss::Loss,
    ) -> Result<Self, GpuError> {
        let instance = Instance::new(InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(target).map_err(|e| GpuError::NoDevice(e.to_string()))?;
        let options = RequestAdapterOptions {
            power_preference: PowerPreference::HighPerformance,
            compatible_surface: Some(&surface),
            ..RequestAdapterOptions::default()
        };
        let adapter = instance.request_adapter(&options).await.map_err(|_| GpuError::NoWebGpu)?;
        let descriptor = DeviceDescriptor { label: Some("ductile"), ..DeviceDescriptor::default() };
        let (device, queue) =
            adapter.request_device(&descriptor).await.map_err(|e| GpuError::NoDevice(e.to_string()))?;
        let teller = loss.teller();
        device.set_device_lost_callback(move |_, reason| teller.tell(reason));
        let format = display_format(&surface, &adapter);
        let samples = if is_software(&adapter) { 1 } else { SAMPLES };
        let config = SurfaceConfiguration {
            usage: TextureUsages::RENDER_ATTACHMENT,
            format,
            color_space: wgpu::SurfaceColorSpace::Auto,
            width: size[0].max(1),
            height: size[1].max(1),
            present_mode: PresentMode::AutoVsync,
            desired_maximum_frame_latency: 2,
            alpha_mode: CompositeAlphaMode::Opaque,
            view_formats: Vec::new(),
        };
        Ok(Self {
            surface,
            config,
            painter: Painter::new(device, queue, format, samples),
            samples,
            adapter_name: adapter.get_info().name,
            is_configured: false,
        })
    }

    /// What the browser calls the device; often empty.
    #[must_use]
    pub fn adapter_name(&self) -> &str {
        &self.adapter_name
    }

    /// Samples of each pixel.
    #[must_use]
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Sets how many samples each pixel has, 1 or 4. Everything else is uploaded anew after this, as on a
    /// new renderer.
    pub fn set_samples(&mut self, samples: u32) {
        let samples = if samples > 1 { SAMPLES } else { 1 };
        if samples != self.samples {
            let (device, queue) = (self.painter.device().clone(), self.painter.queue().clone());
            self.painter = Painter::new(device, queue, self.config.format, samples);
            self.samples = samples;
        }
    }

    /// Tells the size of the canvas in device pixels.
    pub fn resize(&mut self, width_px: u32, height_px: u32) {
        let largest = self.painter.device().limits().max_texture_dimension_2d;
        let (width, height) = (width_px.clamp(1, largest), height_px.clamp(1, largest));
        if (width, height) != (self.config.width, self.config.height) {
            self.config.width = width;
            self.config.height = height;
            self.is_configured = false;
        }
    }

    /// Takes spans and triangles of a scene; its numbers must follow.
    pub fn upload_structure(&mut self, scene: &Scene) {
        self.painter.upload_structure(scene);
    }

    /// Takes the numbers of a frame.
    pub fn upload_frame(&mut self, scene: &Scene) {
        self.painter.upload_frame(scene);
    }

    /// Draws a picture.
    ///
    /// # Errors
    ///
    /// [`GpuError::NotReady`] if there is nothing to draw on at the moment, [`GpuError::Lost`] if there
    /// never will be.
    pub fn draw(&mut self, camera: &Camera, look: &Look, highlight: &Highlight) -> Result<(), GpuError> {
        if !self.is_configured {
            self.surface.configure(self.painter.device(), &self.config);
            self.is_configured = true;
        }
        let texture = match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(texture) | CurrentSurfaceTexture::Suboptimal(texture) => texture,
            CurrentSurfaceTexture::Lost => return Err(GpuError::Lost),
            CurrentSurfaceTexture::Timeout | CurrentSurfaceTexture::Occluded => {
                return Err(GpuError::NotReady);
            }
            CurrentSurfaceTexture::Outdated | CurrentSurfaceTexture::Validation => {
                self.is_configured = false;
                return Err(GpuError::NotReady);
            }
        };
        let view = texture.texture.create_view(&TextureViewDescriptor::default());
        self.painter.paint(&view, [self.config.width, self.config.height], camera, look, highlight);
        self.painter.queue().present(texture);
        Ok(())
    }

    /// Gives the device up, as if it had been lost; for tests of that.
    pub fn destroy_device(&self) {
        self.painter.device().destroy();
    }
}

/// A format without sRGB: the shaders encode their colours themselves, the same way everywhere.
fn display_format(surface: &Surface<'_>, adapter: &Adapter) -> TextureFormat {
    let formats = surface.get_capabilities(adapter).formats;
    let plain = formats.iter().copied().find(|format| !format.is_srgb());
    plain.or(formats.first().copied()).unwrap_or(TextureFormat::Bgra8Unorm)
}

/// Whether the processor draws; then one sample must do.
fn is_software(adapter: &Adapter) -> bool {
    let info = adapter.get_info();
    let name = info.name.to_ascii_lowercase();
    info.device_type == DeviceType::Cpu
        || ["swiftshader", "llvmpipe", "lavapipe"].iter().any(|n| name.contains(n))
}
