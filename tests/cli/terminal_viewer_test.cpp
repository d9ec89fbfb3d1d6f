#include "jobs/support/terminal_viewer.h"

#include <gmock/gmock.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <thread>

#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

/// A pseudo-terminal whose output is recorded.
class Terminal {
 public:
  Terminal(unsigned short columns, unsigned short rows) {
    winsize size{};
    size.ws_col = columns, size.ws_row = rows;
    int terminal = -1;
    EXPECT_EQ(openpty(&screen_, &terminal, nullptr, nullptr, &size), 0);
    file_ = ::fdopen(terminal, "w");
    reader_ = std::thread([this] {
      std::array<char, 4096> piece;
      for (ssize_t n; (n = ::read(screen_, piece.data(), piece.size())) > 0;) text_.append(piece.data(), size_t(n));
    });
  }
  ~Terminal() { text(); }
  std::FILE* file() const { return file_; }
  void resize(unsigned short columns, unsigned short rows) const {
    winsize size{};
    size.ws_col = columns, size.ws_row = rows;
    EXPECT_EQ(::ioctl(screen_, TIOCSWINSZ, &size), 0);
  }
  /// Returns the whole output and closes the terminal.
  const std::string& text() {
    if (!reader_.joinable()) return text_;
    std::fclose(file_);
    reader_.join();
    ::close(screen_);
    return text_;
  }

 private:
  int screen_ = -1;
  std::FILE* file_ = nullptr;
  std::string text_;
  std::thread reader_;
};

Image white_image(int width, int height) {
  Image image(width, height, {"S0.551,000000nm", "R", "G", "B"});
  std::ranges::fill(image.pixels, 1.0f);
  return image;
}

TEST(TerminalViewers, DrawOverWhatTheyHaveDrawn) {
  Terminal terminal(30, 20);
  TerminalViewer viewer(terminal.file(), "linear sRGB", {});
  viewer.show(white_image(60, 30));  // 30 x 15 pixels, 8 lines
  viewer.show(white_image(60, 30));
  terminal.resize(10, 5);
  viewer.show(white_image(60, 30));  // 10 x 5 pixels, 3 lines
  terminal.resize(200, 6);
  viewer.show(white_image(60, 30));  // 16 x 8 pixels: two lines are left
  const std::string line = "\x1b[0m\r\n", white = "\x1b[38;2;255;255;255m\x1b[48;2;255;255;255m▀";
  const auto image = [&](int columns, int rows) {
    std::string text;
    for (int y = 0; y < rows; y += 2) {
      for (int x = 0; x < columns; ++x) text += y + 1 < rows ? white : "\x1b[38;2;255;255;255m▀";
      text += line;
    }
    return text;
  };
  EXPECT_EQ(terminal.text(), "\r\x1b[K\x1b[J" + image(30, 15) + "\r\x1b[8A" + image(30, 15) + "\r\x1b[8A\x1b[J" +
                                 image(10, 5) + "\r\x1b[3A\x1b[J" + image(16, 8));
}

TEST(TerminalViewers, RefuseDisplaysThatAreNotThere) {
  EXPECT_THAT(error_of([] { TerminalViewer(stderr, "linear sRGB", {.display = "foo", .view = {}}); }),
              HasSubstr("unknown display \"foo\""));
}

}  // namespace
}  // namespace frond
