// Files of named arrays, the container of RGL's measured materials (Dupuy and Jakob 2018). Little
// endian: the 12 bytes "tensor_file\0", two bytes of version (1, 0), uint32 number of fields; per
// field uint16 length of its name, the name, uint16 number of dimensions, uint8 type, uint64 where
// its values are, and uint64 per dimension. The last dimension varies fastest.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lockstep {

// An array of float32.
struct FloatTensor {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

class TensorFile {
 public:
  // Throws Error, one line that begins with the path, where the file is missing, larger than
  // 512 MiB, cut short or of another format.
  explicit TensorFile(const std::string& path);

  bool has(const std::string& name) const { return fields_.count(name) > 0; }

  // Throws Error as above where there is no such field of so many dimensions and of finite float32
  // values.
  FloatTensor floats(const std::string& name, std::size_t dimensions) const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  struct Field {
    std::uint8_t type = 0;
    std::uint64_t offset = 0;
    std::vector<std::size_t> shape;
  };
  void read_field(std::size_t& at);
  template <class T>
  T take(std::size_t& at) const;

  std::string path_;
  std::string bytes_;
  std::map<std::string, Field> fields_;
};

}  // namespace lockstep
