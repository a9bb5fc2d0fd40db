#include "core/serialized_mesh.h"

#include "core/error.h"

#include <glm/geometric.hpp>

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

namespace lockstep {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

enum Flag : std::uint32_t {
  has_normals = 0x0001,
  has_uvs = 0x0002,
  has_colors = 0x0008,
  face_normals = 0x0010,
  double_precision = 0x2000,
};

class File {
 public:
  explicit File(const std::string& path) : path_(path), stream_(path, std::ios::binary) {
    if (!stream_) throw Error(path + ": cannot be opened; check the path");
    stream_.seekg(0, std::ios::end);
    const std::streamoff end = stream_.tellg();
    if (end < 0) throw Error(path + ": is not a file that can be read; check the path");
    size_ = std::uint64_t(end);
  }

  [[noreturn]] void fail(const std::string& what) const { throw Error(path_ + ": " + what); }

  std::uint64_t size() const { return size_; }

  template <class T>
  T read_at(std::uint64_t offset) {
    T value{};
    read_at(offset, &value, sizeof(T));
    return value;
  }

  void read_at(std::uint64_t offset, void* to, std::size_t bytes) {
    if (bytes > size_ || offset > size_ - bytes) fail("the file is cut short");
    stream_.seekg(std::streamoff(offset));
    stream_.read(static_cast<char*>(to), std::streamsize(bytes));
    if (!stream_) fail("the file cannot be read");
  }

 private:
  std::string path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

struct Header {
  std::uint16_t format = 0, version = 0;
};

Header read_header(File& file, std::uint64_t offset) {
  const Header header{file.read_at<std::uint16_t>(offset), file.read_at<std::uint16_t>(offset + 2)};
  if (header.format != 0x041C) file.fail("is not a .serialized file of Mitsuba");
  if (header.version != 3 && header.version != 4) {
    file.fail("has version " + std::to_string(header.version) +
              "; only 3 and 4 are understood, so convert the mesh to PLY");
  }
  return header;
}

struct Extent {
  std::uint64_t begin = 0, end = 0;
};

// Where mesh `index` lies, its header included.
Extent find_mesh(File& file, int index) {
  const bool wide = read_header(file, 0).version == 4;
  const std::uint64_t entry = wide ? 8 : 4;
  const auto count = file.read_at<std::uint32_t>(file.size() - 4);
  if (index < 0 || std::uint32_t(index) >= count) {
    file.fail("has " + std::to_string(count) + " meshes; there is no number " +
              std::to_string(index) + " (they count from 0)");
  }
  const std::uint64_t table_size = entry * count + 4;
  if (table_size > file.size()) file.fail("the table of meshes is cut short");
  const std::uint64_t table = file.size() - table_size;
  const auto offset = [&](std::uint64_t i) -> std::uint64_t {
    if (wide) return file.read_at<std::uint64_t>(table + entry * i);
    return file.read_at<std::uint32_t>(table + entry * i);
  };
  const auto i = std::uint64_t(index);
  Extent extent{offset(i), i + 1 < count ? offset(i + 1) : table};
  // Files whose meshes lie in another order are read up to the table.
  if (extent.end <= extent.begin) extent.end = table;
  if (extent.begin >= table || extent.end > table) file.fail("the table of meshes is damaged");
  return extent;
}

// Decompresses a zlib stream piece by piece.
class Inflater {
 public:
  Inflater(File& file, std::vector<unsigned char> compressed)
      : file_(file), compressed_(std::move(compressed)) {
    z_.next_in = compressed_.data();
    z_.avail_in = uInt(compressed_.size());
    if (inflateInit(&z_) != Z_OK) file_.fail("cannot be decompressed");
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&z_); }

  void read(void* to, std::size_t bytes) {
    auto* out = static_cast<unsigned char*>(to);
    while (bytes > 0) {
      const auto piece = uInt(std::min<std::size_t>(bytes, 1u << 30));
      z_.next_out = out;
      z_.avail_out = piece;
      const int status = inflate(&z_, Z_SYNC_FLUSH);
      const std::size_t written = piece - z_.avail_out;
      out += written;
      bytes -= written;
      if (bytes == 0) return;
      if (status != Z_OK || written == 0) file_.fail("a mesh is cut short or damaged");
    }
  }

  template <class T>
  T value() {
    T v{};
    read(&v, sizeof(T));
    return v;
  }

  // Refuses counts that the rest of the stream cannot hold, before memory is asked for: deflate
  // packs no more than 1032 bytes into one (zlib.net, "Maximum Compression Factor").
  void check_count(std::uint64_t count, std::uint64_t bytes_each) const {
    const std::uint64_t most = 1032 * (std::uint64_t(compressed_.size()) + 64);
    if (count > most / bytes_each || count > std::numeric_limits<std::int32_t>::max()) {
      file_.fail("a mesh is too short for the " + std::to_string(count) + " elements it claims");
    }
  }

  File& file() const { return file_; }

 private:
  File& file_;
  std::vector<unsigned char> compressed_;
  z_stream z_{};
};

// `count` values, of double precision where the file has that.
std::vector<float> read_floats(Inflater& in, std::size_t count, bool doubles) {
  std::vector<float> values(count);
  if (!doubles) {
    in.read(values.data(), count * sizeof(float));
  } else {
    std::vector<double> wide(count);
    in.read(wide.data(), count * sizeof(double));
    std::transform(wide.begin(), wide.end(), values.begin(), [](double v) { return float(v); });
  }
  return values;
}

glm::vec3 unit(glm::vec3 n) {
  const float length = glm::length(n);
  return length > 0.0f && std::isfinite(length) ? n / length : glm::vec3(0.0f, 0.0f, 1.0f);
}

void read_vertices(Inflater& in, std::uint32_t flags, std::size_t count, TriangleMesh& mesh) {
  const bool doubles = (flags & double_precision) != 0u;
  const std::vector<float> p = read_floats(in, 3 * count, doubles);
  // Squared lengths beyond would leave the range of float.
  constexpr float largest = 1e18f;
  if (!std::all_of(p.begin(), p.end(), [](float v) { return std::abs(v) <= largest; })) {
    in.file().fail("a mesh has a vertex that is not finite or farther than 1e18 from the origin");
  }
  mesh.positions.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    mesh.positions[i] = {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
  }
  if (flags & has_normals) {
    const std::vector<float> n = read_floats(in, 3 * count, doubles);
    mesh.normals.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      mesh.normals[i] = unit({n[3 * i], n[3 * i + 1], n[3 * i + 2]});
    }
  }
  if (flags & has_uvs) {
    const std::vector<float> t = read_floats(in, 2 * count, doubles);
    const auto finite = [](float v) { return std::isfinite(v) ? v : 0.0f; };
    mesh.uvs.resize(count);
    for (std::size_t i = 0; i < count; ++i) mesh.uvs[i] = {finite(t[2 * i]), finite(t[2 * i + 1])};
  }
  if (flags & has_colors) read_floats(in, 3 * count, doubles);
}

void read_triangles(Inflater& in, std::size_t count, TriangleMesh& mesh) {
  std::vector<std::uint32_t> indices(3 * count);
  in.read(indices.data(), indices.size() * sizeof(std::uint32_t));
  mesh.triangles.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t index = indices[3 * i + size_t(k)];
      if (index >= mesh.positions.size()) {
        in.file().fail("triangle " + std::to_string(i) + " refers to vertex " +
                       std::to_string(index) + ", but there are " +
                       std::to_string(mesh.positions.size()));
      }
      mesh.triangles[i][k] = index;
    }
  }
}

}  // namespace

SerializedMesh read_serialized_mesh(const std::string& path, int index) {
  File file(path);
  const Extent extent = find_mesh(file, index);
  const bool named = read_header(file, extent.begin).version == 4;
  const std::uint64_t size =
      extent.end - extent.begin - std::min<std::uint64_t>(4, extent.end - extent.begin);
  if (size > std::numeric_limits<uInt>::max()) file.fail("a mesh is larger than 4 GiB");
  std::vector<unsigned char> compressed(size);
  file.read_at(extent.begin + 4, compressed.data(), compressed.size());
  Inflater in(file, std::move(compressed));

  const auto flags = in.value<std::uint32_t>();
  if (named) {
    constexpr int longest = 1 << 16;
    int length = 0;
    while (in.value<char>() != '\0') {
      if (++length > longest) file.fail("the name of a mesh has no end");
    }
  }
  const auto vertices = in.value<std::uint64_t>(), triangles = in.value<std::uint64_t>();
  in.check_count(vertices, flags & double_precision ? 24 : 12);
  in.check_count(triangles, 12);
  SerializedMesh result;
  result.face_normals = (flags & face_normals) != 0u;
  read_vertices(in, flags, vertices, result.mesh);
  read_triangles(in, triangles, result.mesh);
  return result;
}

}  // namespace lockstep
