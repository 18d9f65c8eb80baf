/* The headers as C99. Counts the members whose C layout is the measured one; the C++ side compares it with the list. */
#include <stddef.h>

#include "abi/ref_tables.h"

int countRightMembers(void);

int countRightMembers(void) {
    int right = 0;
#define Q3_SIZE(type, size) right += sizeof(type) == (size);
#define Q3_OFFSET(type, member, offset) right += offsetof(type, member) == (offset);
#include "abi/layout.def.h"
    return right;
}
