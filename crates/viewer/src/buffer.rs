//! Buffers that live as long as the device and grow by doubling, so that a frame allocates nothing.

use wgpu::{Buffer, BufferDescriptor, BufferUsages, Device, Queue};

/// Large enough for one element of anything, so that an empty buffer can be bound.
const LEAST: u64 = 256;

/// A storage buffer that grows.
#[derive(Debug)]
pub(crate) struct GrowingBuffer {
    label: &'static str,
    buffer: Buffer,
}

impl GrowingBuffer {
    pub(crate) fn new(device: &Device, label: &'static str) -> Self {
        Self { label, buffer: storage(device, label, LEAST) }
    }

    /// The buffer of now; another one after a write that said so.
    pub(crate) fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// Writes from the start; true if the buffer had to be replaced, and must be bound anew.
    pub(crate) fn write<T: bytemuck::NoUninit>(
        &mut self,
        device: &Device,
        queue: &Queue,
        data: &[T],
    ) -> bool {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let size = bytes.len() as u64;
        let grows = size > self.buffer.size();
        if grows {
            self.buffer = storage(device, self.label, size.next_power_of_two());
        }
        if !bytes.is_empty() {
            queue.write_buffer(&self.buffer, 0, bytes);
        }
        grows
    }
}

fn storage(device: &Device, label: &str, size: u64) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size,
        usage: BufferUsages::STORAGE | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
