#include "media/nanovdb_grid.h"

#ifdef FROND_HAS_NANOVDB

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/IO.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "core/stop.h"

namespace frond {
namespace {

// Levels of the tree of a float grid: nodes of 32^3, 16^3 and 8^3 children or values (Museth 2013 and 2021).
using Grid = nanovdb::FloatGrid;
using Tree = Grid::TreeType;
using Root = Tree::RootType;
using Upper = Root::ChildNodeType;
using Lower = Upper::ChildNodeType;
using Leaf = Lower::ChildNodeType;

/// First words of files and grids. NanoVDB 32.6 and later write their own; the layouts are the same within a major
/// version.
constexpr uint64_t kOldMagic = NANOVDB_MAGIC_NUMBER;  // "NanoVDB0", of files and grids
constexpr uint64_t kGridMagic = 0x314244566f6e614e;   // "NanoVDB1"
constexpr uint64_t kFileMagic = 0x324244566f6e614e;   // "NanoVDB2"

/// NanoVDB accesses nodes in place, so that the memory must have its alignment, 32 bytes.
constexpr std::align_val_t kAlignment{NANOVDB_DATA_ALIGNMENT};
struct Free {
  void operator()(std::byte* bytes) const { ::operator delete(bytes, kAlignment); }
};
using Memory = std::unique_ptr<std::byte[], Free>;

/// Reader of the file's bytes that never goes beyond them.
class Bytes {
 public:
  Bytes(std::string_view bytes, const std::string& file, const Location& where)
      : bytes_(bytes), file_(file), where_(where) {}

  [[noreturn]] void reject(const std::string& what) const { fail(where_, "NanoVDB file \"{}\": {}", file_, what); }
  /// Refuses versions whose layouts differ.
  void check_version(const nanovdb::Version& v) const {
    if (v.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
      reject(fmt::format("it is of version {}.{}.{}, versions {}.x are read", v.getMajor(), v.getMinor(), v.getPatch(),
                         NANOVDB_MAJOR_VERSION_NUMBER));
  }
  /// True at the end of the file.
  bool empty() const { return bytes_.empty(); }
  /// Returns the next bytes and advances. Throws InputError if the file is shorter.
  std::string_view take(uint64_t size) {
    const std::string_view taken = next(size);
    bytes_.remove_prefix(size);
    return taken;
  }
  /// Returns the next value and advances. Its bytes are copied, because they may be unaligned.
  template <class T>
  T take() {
    const T value = next<T>();
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  /// The value that `take` would return.
  template <class T>
  T next() const {
    T value;
    std::memcpy(static_cast<void*>(&value), next(sizeof value).data(), sizeof value);
    return value;
  }

 private:
  std::string_view next(uint64_t size) const {
    if (size > bytes_.size()) reject("it is truncated");
    return bytes_.substr(0, size);
  }

  std::string_view bytes_;
  const std::string& file_;
  const Location& where_;
};

/// Checks that every offset of a grid leads to a node of the right level inside its memory, to each node at most once,
/// and that values are finite.
class NodeCheck {
 public:
  NodeCheck(const std::byte* memory, uint64_t size, const Bytes& file) : memory_(memory), size_(size), file_(file) {}

  void check() const {
    const auto& grid = *reinterpret_cast<const nanovdb::GridData*>(memory_);
    if (size_ < sizeof(nanovdb::GridData) + sizeof(Tree) || (grid.mMagic != kOldMagic && grid.mMagic != kGridMagic))
      reject_damaged();
    file_.check_version(grid.mVersion);
    if (grid.mGridType != nanovdb::GridType::Float)
      file_.reject("its grid does not hold 32-bit floats, which medium \"nanovdb\" takes");
    if (grid.mGridClass != nanovdb::GridClass::FogVolume && grid.mGridClass != nanovdb::GridClass::Unknown)
      file_.reject("its grid is no fog volume");
    check_map(grid.mMap);
    const auto& tree = *reinterpret_cast<const nanovdb::TreeData<3>*>(memory_ + sizeof(nanovdb::GridData));
    Level<Leaf> leaves = level<Leaf>(tree, 0);
    Level<Lower> lowers = level<Lower>(tree, 1);
    Level<Upper> uppers = level<Upper>(tree, 2);
    check_root(tree, uppers);
    for (uint64_t i = 0; i < uppers.count; ++i) check_node(uppers.begin[i], lowers);
    for (uint64_t i = 0; i < lowers.count; ++i) check_node(lowers.begin[i], leaves);
    StopPoll poll;
    for (uint64_t i = 0; i < leaves.count; ++i, poll())
      for (const float v : leaves.begin[i].data()->mValues) check_finite(v);
  }

 private:
  template <class Node>
  struct Level {
    const Node* begin;
    uint64_t count;
    std::vector<bool> is_taken;
    /// Returns whether a node begins at the address that has not been taken before.
    bool take(const void* node) {
      const auto offset = static_cast<const std::byte*>(node) - reinterpret_cast<const std::byte*>(begin);
      if (!node || offset < 0 || uint64_t(offset) >= count * sizeof(Node) || uint64_t(offset) % sizeof(Node) != 0)
        return false;
      const size_t i = uint64_t(offset) / sizeof(Node);
      const bool is_new = !is_taken[i];
      is_taken[i] = true;
      return is_new;
    }
  };

  [[noreturn]] void reject_damaged() const { file_.reject("it is damaged"); }
  void check_finite(float v) const {
    if (!std::isfinite(v)) file_.reject("it holds a number that is not finite");
  }
  /// Checks that the index-to-world matrix and its stored inverse agree to 1 %, as lookups use the inverse.
  void check_map(const nanovdb::Map& map) const {
    constexpr float kRounding = 1e-2f;
    for (const float v : map.mVecF) check_finite(v);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) {
        float sum = 0;
        for (int k = 0; k < 3; ++k) sum += map.mMatF[3 * row + k] * map.mInvMatF[3 * k + column];
        if (!(std::abs(sum - float(row == column)) < kRounding)) file_.reject("its transformation has no inverse");
      }
  }
  /// Address at an offset from the tree; throws if `size` bytes do not fit there.
  const std::byte* at(uint64_t offset, uint64_t size) const {
    const uint64_t room = size_ - sizeof(nanovdb::GridData);
    if (offset > room || size > room - offset || offset % NANOVDB_DATA_ALIGNMENT != 0) reject_damaged();
    return memory_ + sizeof(nanovdb::GridData) + offset;
  }
  template <class Node>
  /// Returns the nodes of a level, which are contiguous in memory. Throws InputError if they exceed it.
  Level<Node> level(const nanovdb::TreeData<3>& tree, int i) const {
    const uint64_t count = tree.mNodeCount[i];
    if (count == 0) return {nullptr, 0, {}};
    return {reinterpret_cast<const Node*>(at(tree.mNodeOffset[i], count * sizeof(Node))), count,
            std::vector<bool>(count)};
  }
  /// Checks the table of the root: a tile has a value or the offset of an upper node.
  void check_root(const nanovdb::TreeData<3>& tree, Level<Upper>& uppers) const {
    using Data = Root::DataType;
    const auto& root = *reinterpret_cast<const Data*>(at(tree.mNodeOffset[3], sizeof(Data)));
    (void)at(tree.mNodeOffset[3], sizeof(Data) + root.mTableSize * uint64_t{sizeof(Data::Tile)});
    check_finite(root.mBackground);
    for (uint32_t i = 0; i < root.mTableSize; ++i) {
      const Data::Tile& tile = *root.tile(i);
      if (tile.child == 0)
        check_finite(tile.value);
      else if (!uppers.take(moved(&root, tile.child)))
        reject_damaged();
    }
  }
  template <class Node, class Child>
  /// Checks the children and values of an inner node, by its mask.
  void check_node(const Node& node, Level<Child>& children) const {
    const auto& data = *node.data();
    for (uint32_t i = 0; i < Node::SIZE; ++i) {
      if (!data.mChildMask.isOn(i))
        check_finite(data.mTable[i].value);
      else if (!children.take(moved(&data, data.mTable[i].child)))
        reject_damaged();
    }
  }
  /// Address `offset` bytes from a node; nullptr if it is outside of the memory.
  const void* moved(const void* from, int64_t offset) const {
    const int64_t start = static_cast<const std::byte*>(from) - memory_;
    return offset >= -start && offset < int64_t(size_) - start ? static_cast<const std::byte*>(from) + offset : nullptr;
  }

  const std::byte* memory_;
  uint64_t size_;
  const Bytes& file_;
};

/// Returns aligned memory. Throws InputError if there is none, as sizes come from the file.
Memory allocate(uint64_t size, const Bytes& file) {
  try {
    return Memory(static_cast<std::byte*>(::operator new(size, kAlignment)));
  } catch (const std::bad_alloc&) {
    file.reject(fmt::format("there is no memory for its grid of {} bytes", size));
  }
}

/// Unpacks a zlib stream, in blocks between which a stop is observed. Returns false unless it fills `to` exactly.
bool inflate_into(std::span<std::byte> to, std::string_view packed) {
  constexpr size_t kBlock = size_t{1} << 24;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, decltype(&inflateEnd)> end(&stream, &inflateEnd);
  for (;;) {
    check_stop();
    if (stream.avail_in == 0) {
      const std::string_view block = packed.substr(0, kBlock);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(block.data()));  // zlib does not write there
      stream.avail_in = uInt(block.size());
      packed.remove_prefix(block.size());
    }
    if (stream.avail_out == 0 && !to.empty()) {
      const std::span<std::byte> block = to.first(std::min(to.size(), kBlock));
      stream.next_out = reinterpret_cast<Bytef*>(block.data());
      stream.avail_out = uInt(block.size());
      to = to.subspan(block.size());
    }
    const int verdict = inflate(&stream, Z_NO_FLUSH);
    if (verdict == Z_STREAM_END) return stream.avail_out == 0 && to.empty();
    if (verdict != Z_OK) return false;
  }
}

/// Returns the grid's bytes. Throws InputError for BLOSC, which is not linked, and for sizes that do not agree.
Memory unpack(nanovdb::io::Codec codec, std::string_view packed, uint64_t size, const Bytes& file) {
  if (codec == nanovdb::io::Codec::BLOSC)
    file.reject("it is compressed by BLOSC; nanovdb_convert --zip writes one that can be read");
  if (codec == nanovdb::io::Codec::NONE) {
    if (packed.size() != size) file.reject("it is damaged");
    Memory memory = allocate(size, file);
    std::memcpy(memory.get(), packed.data(), size);
    return memory;
  }
  // Checked before memory is allocated: no stream of this length unpacks to a larger size.
  constexpr uint64_t kMostRatio = 1040;  // deflate's is 1032
  if (packed.size() < sizeof(uint64_t) || size / kMostRatio > packed.size()) file.reject("it is damaged");
  const std::string_view stream = packed.substr(sizeof(uint64_t));
  Memory memory = allocate(size, file);
  if (!inflate_into({memory.get(), size}, stream)) file.reject("it is damaged");
  return memory;
}

/// Checked grid in its own memory. Lookups are thread-safe: each one has its accessor.
class LoadedGrid final : public NanoVdbGrid {
 public:
  LoadedGrid(Memory memory, const Bytes& file)
      : memory_(std::move(memory)), grid_(*reinterpret_cast<Grid*>(memory_.get())) {
    // Nothing is outside of a fog volume; some writers leave the half width of the level set that it was made from.
    const_cast<Root::DataType*>(grid_.tree().root().data())->mBackground = 0;
    const auto box = grid_.worldBBox();
    bounds_ = {vec3(box.min()), vec3(box.max())};
    for (int axis = 0; axis < 3; ++axis)
      if (!(bounds_.min[axis] < bounds_.max[axis] && bounds_.max[axis] - bounds_.min[axis] < INFINITY))
        file.reject("its grid is empty");
  }

  /// Trilinear interpolation; negative values count as 0, because a density is not negative.
  float at(const Vec3& p) const override {
    const auto index = grid_.worldToIndexF(nanovdb::Vec3f(p.x, p.y, p.z));
    const auto accessor = grid_.getAccessor();
    float t[3];
    int corner[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float x = std::clamp(index[axis], -kFarthest, kFarthest), low = std::floor(x);
      corner[axis] = int(low), t[axis] = x - low;
    }
    float sum = 0;
    for (int k = 0; k < 8; ++k) {
      const int dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
      const float weight = (dx ? t[0] : 1 - t[0]) * (dy ? t[1] : 1 - t[1]) * (dz ? t[2] : 1 - t[2]);
      sum += weight * std::max(0.f, accessor.getValue({corner[0] + dx, corner[1] + dy, corner[2] + dz}));
    }
    return sum;
  }
  Bounds bounds() const override { return bounds_; }

  void for_each(const std::function<void(const Vec3&, const Vec3&, float)>& use) const override {
    const Root::DataType& root = *grid_.tree().root().data();
    for (uint32_t i = 0; i < root.mTableSize; ++i) {
      const auto& tile = *root.tile(i);
      if (tile.child == 0)
        emit(tile.origin(), Upper::DIM, tile.value, use);
      else
        visit(*root.getChild(&tile), tile.origin(), use);
    }
  }

 private:
  /// Indices are clamped to this magnitude, which converts to int without overflow.
  static constexpr float kFarthest = 0x1p30f;

  template <class V>
  static Vec3 vec3(const V& v) {
    return {float(v[0]), float(v[1]), float(v[2])};
  }
  /// A value that fills `size` indices along each axis reaches to the neighbouring indices.
  template <class Use>
  void emit(const nanovdb::Coord& origin, int size, float value, const Use& use) const {
    if (!(value > 0)) return;
    // 0.001 index more than one index beyond the value, for rounding of the transform.
    const float half = float(size - 1) / 2, reach = half + 1.001f;
    const Vec3 middle = vec3(
        grid_.indexToWorldF(nanovdb::Vec3f(float(origin[0]) + half, float(origin[1]) + half, float(origin[2]) + half)));
    const auto& m = reinterpret_cast<const nanovdb::GridData*>(memory_.get())->mMap.mMatF;
    const Vec3 extent{(std::abs(m[0]) + std::abs(m[1]) + std::abs(m[2])) * reach,
                      (std::abs(m[3]) + std::abs(m[4]) + std::abs(m[5])) * reach,
                      (std::abs(m[6]) + std::abs(m[7]) + std::abs(m[8])) * reach};
    use(middle - extent, middle + extent, value);
  }
  /// Indices follow from the path to a node, as in lookups; x is the slowest.
  template <class Node, class Use>
  void visit(const Node& node, const nanovdb::Coord& origin, const Use& use) const {
    constexpr int kSize = Node::DIM >> Node::LOG2DIM;
    const auto& data = *node.data();
    for (uint32_t i = 0; i < Node::SIZE; ++i) {
      constexpr uint32_t kMask = (1u << Node::LOG2DIM) - 1;
      const nanovdb::Coord at(origin[0] + int(i >> 2 * Node::LOG2DIM) * kSize,
                              origin[1] + int(i >> Node::LOG2DIM & kMask) * kSize, origin[2] + int(i & kMask) * kSize);
      if constexpr (std::is_same_v<Node, Leaf>)
        emit(at, 1, data.mValues[i], use);
      else if (data.mChildMask.isOn(i))
        visit(*data.getChild(i), at, use);
      else
        emit(at, kSize, data.mTable[i].value, use);
    }
  }

  Memory memory_;
  const Grid& grid_;
  Bounds bounds_;
};

/// Unpacks and checks a grid. Throws InputError if it is damaged.
std::unique_ptr<NanoVdbGrid> load(nanovdb::io::Codec codec, std::string_view packed, uint64_t size, const Bytes& file) {
  Memory memory = unpack(codec, packed, size, file);
  NodeCheck(memory.get(), size, file).check();
  return std::make_unique<LoadedGrid>(std::move(memory), file);
}

/// Reads a file that is grids one after the other, without compression.
std::unique_ptr<NanoVdbGrid> read_raw(Bytes& file, std::string_view name) {
  while (!file.empty()) {
    const auto grid = file.next<nanovdb::GridData>();
    if (grid.mMagic != kGridMagic || grid.mGridSize < sizeof grid) file.reject("it is damaged");
    const std::string_view bytes = file.take(grid.mGridSize), text(grid.mGridName, sizeof grid.mGridName);
    if (text.substr(0, text.find('\0')) == name) return load(nanovdb::io::Codec::NONE, bytes, grid.mGridSize, file);
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<NanoVdbGrid> NanoVdbGrid::read(std::string_view all, const std::string& name_of_file,
                                               std::string_view name, const Location& where) {
  Bytes file(all, name_of_file, where);
  if (!file.empty() && file.next<uint64_t>() == kGridMagic) return read_raw(file, name);
  while (!file.empty()) {
    const auto header = file.take<nanovdb::io::Header>();
    if (header.magic != kOldMagic && header.magic != kFileMagic) file.reject("it does not begin as one");
    file.check_version(header.version);
    if (header.codec >= nanovdb::io::Codec::END) file.reject("its compression is unknown");
    std::vector<std::pair<nanovdb::io::MetaData, std::string_view>> grids;
    for (int i = 0; i < header.gridCount; ++i) {
      const auto meta = file.take<nanovdb::io::MetaData>();
      const std::string_view text = file.take(meta.nameSize);
      grids.emplace_back(meta, text.substr(0, text.find('\0')));
    }
    for (const auto& [meta, text] : grids) {
      const std::string_view packed = file.take(meta.fileSize);
      if (text != name) continue;
      return load(header.codec, packed, meta.gridSize, file);
    }
  }
  return nullptr;
}

}  // namespace frond

#else

namespace frond {

std::unique_ptr<NanoVdbGrid> NanoVdbGrid::read(std::string_view, const std::string&, std::string_view,
                                               const Location& where) {
  fail(where, "this frond was built without NanoVDB (libnanovdb-dev)");
}

}  // namespace frond

#endif
