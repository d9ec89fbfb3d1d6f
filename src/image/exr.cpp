#include "image/exr.h"

#include <OpenEXR/IexBaseExc.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <thread>

namespace frond {
namespace {

/// Stream into memory; replace_file then writes the complete file to the disk.
class MemoryStream final : public Imf::OStream {
 public:
  MemoryStream() : OStream("memory") {}
  void write(const char* bytes, int count) override {
    const size_t end = at_ + size_t(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + at_, bytes, size_t(count));
    at_ = end;
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t at) override { at_ = at; }
  std::vector<unsigned char> take() { return std::move(bytes_); }

 private:
  std::vector<unsigned char> bytes_;
  size_t at_ = 0;
};

/// Lets OpenEXR compress with all hardware threads, unless the program has already set its number of threads.
void start_threads() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (Imf::globalThreadCount() == 0) Imf::setGlobalThreadCount(int(std::thread::hardware_concurrency()));
  });
}

Imath::V2f xy(const Chromaticity& c) { return {float(c.x), float(c.y)}; }

Imf::Header make_header(const Image& image, const ImageHeader& header) {
  const Imath::V2i low{header.x, header.y}, size{image.width, image.height}, one{1, 1};
  const Imath::Box2i data{low, low + size - one};
  const Imath::V2i whole = header.full_width > 0 ? Imath::V2i{header.full_width, header.full_height} : size;
  Imf::Header exr(Imath::Box2i{{0, 0}, whole - one}, data);
  exr.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [key, value] : header.text) exr.insert(key, Imf::StringAttribute(value));
  for (const auto& [key, m] : header.matrices) {
    Imath::M44f matrix;
    std::ranges::copy(m, matrix.getValue());
    exr.insert(key, Imf::M44fAttribute(matrix));
  }
  if (header.samples > 0) exr.insert("samplesPerPixel", Imf::IntAttribute(header.samples));
  if (const Chromaticities* c = chromaticities_of(header.color_space))
    Imf::addChromaticities(exr, Imf::Chromaticities(xy(c->red), xy(c->green), xy(c->blue), xy(c->white)));
  return exr;
}

}  // namespace

std::vector<unsigned char> encode_exr(const Image& image, const ImageHeader& header, ExrDepth depth) try {
  const size_t channels = image.channels.size();
  Imf::Header exr = make_header(image, header);
  const Imath::Box2i& window = exr.dataWindow();
  std::vector<half> halves(depth == ExrDepth::half ? image.pixels.size() : 0);
  std::transform(image.pixels.begin(), image.pixels.begin() + ptrdiff_t(halves.size()), halves.begin(),
                 [](float v) { return half(v); });
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < channels; ++c) {
    const std::string& name = image.channels[c];
    const bool is_half =
        depth == ExrDepth::half && std::ranges::find(header.full_precision, name) == header.full_precision.end();
    const size_t value = is_half ? sizeof(half) : sizeof(float);
    const void* first = is_half ? static_cast<const void*>(halves.data() + c) : image.pixels.data() + c;
    const Imf::PixelType type = is_half ? Imf::HALF : Imf::FLOAT;
    exr.channels().insert(name, Imf::Channel(type));
    frame.insert(name, Imf::Slice::Make(type, first, window, channels * value, channels * value * size_t(image.width)));
  }
  start_threads();
  MemoryStream memory;
  {
    Imf::OutputFile out(memory, exr);
    out.setFrameBuffer(frame);
    out.writePixels(image.height);
  }
  return memory.take();
} catch (const Iex::BaseExc& e) {
  fail({}, "cannot encode an EXR: {}", e.what());
}

void round_to_halves(std::span<float> values) {
  for (float& v : values) v = half(v);
}

}  // namespace frond
