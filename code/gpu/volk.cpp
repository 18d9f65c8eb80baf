// The one place where volk's function pointers are defined (Debian 12 packages it as source to include).
#define VOLK_IMPLEMENTATION
#include <volk.h>
