// Loaded before a program (LD_PRELOAD): METIS never returns.
#include <unistd.h>

int cholmod_metis(void) {
  for (;;) pause();
}
