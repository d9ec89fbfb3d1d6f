// Loads a scene, renders it with two models of its leaves, and reads pixels: embed SCENE
#include <cmath>
#include <cstdio>

#include "render/session.h"

namespace {

/// Reports the progress of a render, and could stop it by a std::stop_source whose token goes into the RenderControl.
class Dots final : public frond::Progress {
 public:
  void update(double fraction, const frond::RenderStatistics&) override {
    for (; shown_ < fraction * 40; ++shown_) std::fputc('.', stderr);
  }
  void finish() override { std::fputc('\n', stderr), shown_ = 0; }

 private:
  int shown_ = 0;
};

frond::Image render(frond::Session& session, frond::SceneDescription description, const char* leaf) {
  apply_overrides({.swaps = {{"*", {leaf, {}}}}, .wavelengths = "smpte", .quick = true}, description,
                  session.registry(), session.log());
  const frond::LoadedScene scene = session.load(std::move(description), {.channels = {"normal"}});
  frond::RenderPart part = scene.empty_part();
  Dots dots;
  session.render(scene, {0, 8}, part, {.progress = &dots});
  return film_image(part.film, part.header.image);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: embed SCENE\n"), 1;
  const frond::ConsoleLog log;
  frond::Session session(log);
  const frond::SceneDescription description = session.read(argv[1]);
  const frond::Image walk = render(session, description, "abm"), lobes = render(session, description, "leaf_simplified");
  double sum = 0;
  for (int y = 0; y < walk.height; ++y)
    for (int x = 0; x < walk.width; ++x) sum += std::pow(double(walk.at(x, y, 1)) - double(lobes.at(x, y, 1)), 2);
  std::printf("%d x %d pixels; green differs by an RMS of %.4f, noise and all\n", walk.width, walk.height,
              std::sqrt(sum / (walk.width * walk.height)));
  return 0;
} catch (const frond::InputError& error) {
  return std::fprintf(stderr, "embed: %s\n", error.what()), 1;
}
