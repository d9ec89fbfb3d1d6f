/* In place of JBIG-KIT (GPL) in the wheel: Debian's libtiff loads these functions, which only TIFF files with the compression
   JBIG, of fax machines, need. Such a file is refused. */
#include <stddef.h>

enum { kRefused = 1 };

void jbg_dec_init(void* state) { (void)state; }
int jbg_dec_in(void* state, unsigned char* data, size_t size, size_t* read) {
  (void)state, (void)data, (void)size;
  if (read) *read = 0;
  return kRefused;
}
unsigned long jbg_dec_getsize(const void* state) { return (void)state, 0; }
unsigned char* jbg_dec_getimage(const void* state, int plane) { return (void)state, (void)plane, (unsigned char*)NULL; }
void jbg_dec_free(void* state) { (void)state; }
const char* jbg_strerror(int code) { return (void)code, "the compression JBIG is not supported"; }
int jbg_newlen(unsigned char* data, size_t size) { return (void)data, (void)size, kRefused; }
void jbg_enc_init(void* state, unsigned long w, unsigned long h, int planes, unsigned char** image, void* out, void* file) {
  (void)state, (void)w, (void)h, (void)planes, (void)image, (void)out, (void)file;
}
void jbg_enc_out(void* state) { (void)state; }
void jbg_enc_free(void* state) { (void)state; }
