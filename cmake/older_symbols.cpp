/// Functions by the versions of their symbols that RHEL 9 has, for what a wheel contains (FrondOlderSymbols.cmake). glibc
/// 2.35 has another hypot, of the same value, which differs in how it reports overflow; libstdc++ of GCC 12 another
/// std::condition_variable::wait, which lets exceptions of cancelled threads pass. The linker's option --wrap renames
/// the calls.
#include <condition_variable>
#include <mutex>

extern "C" {
double frond_hypot(double x, double y);
float frond_hypotf(float x, float y);
void frond_wait(std::condition_variable* condition, std::unique_lock<std::mutex>* lock);
__asm__(".symver frond_hypot,hypot@GLIBC_2.2.5");
__asm__(".symver frond_hypotf,hypotf@GLIBC_2.2.5");
__asm__(".symver frond_wait,_ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE@GLIBCXX_3.4.11");

[[gnu::visibility("hidden")]] double __wrap_hypot(double x, double y) { return frond_hypot(x, y); }
[[gnu::visibility("hidden")]] float __wrap_hypotf(float x, float y) { return frond_hypotf(x, y); }
[[gnu::visibility("hidden")]] void __wrap__ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE(std::condition_variable* condition,
                                                                      std::unique_lock<std::mutex>* lock) {
  frond_wait(condition, lock);
}
}
