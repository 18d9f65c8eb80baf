#include <gtest/gtest.h>

#include "abi/ref_tables.h"

extern "C" int countRightMembers(void);

namespace {

TEST(Abi, EverySizeAndOffsetHoldsInC) {
    int listed = 0;
#define Q3_SIZE(type, size) ++listed;
#define Q3_OFFSET(type, member, offset) ++listed;
#include "abi/layout.def.h"
    EXPECT_EQ(listed, 176);
    EXPECT_EQ(countRightMembers(), listed);
}

TEST(Abi, TablesHoldNothingButPointers) {
    EXPECT_EQ(sizeof(refexport_t), 30 * sizeof(void*));
    EXPECT_EQ(sizeof(refimport_t), 40 * sizeof(void*));
}

} // namespace
