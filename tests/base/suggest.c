/* Suggestions: one change is near, another word is not. */
#include "base/suggest.h"

#include "support/test.h"

static const char *const names[] = {"young", "poisson", "density", "characteristic_length", "e1"};

static const char *near(const char *word) {
  return cdem_suggest(word, names, 5);
}

static void one_change_is_near(void **state) {
  (void)state;
  assert_string_equal(near("yuong"), "young");     /* swapped */
  assert_string_equal(near("yong"), "young");      /* left out */
  assert_string_equal(near("youngs"), "young");    /* added */
  assert_string_equal(near("poissom"), "poisson"); /* changed */
  assert_string_equal(near("POISSON"), "poisson");
  assert_string_equal(near("characteristic_lenght"), "characteristic_length");
  assert_string_equal(near("e2"), "e1");
}

static void other_words_are_not(void **state) {
  (void)state;
  assert_null(near("thickness"));
  assert_null(near("x"));
  assert_null(near(""));
  assert_null(cdem_suggest("young", names, 0));
  const char *const hole[] = {NULL, "young"};
  assert_string_equal(cdem_suggest("yung", hole, 2), "young");
  char longest[200];
  memset(longest, 'a', sizeof longest - 1);
  longest[199] = '\0';
  assert_null(near(longest));
}

static void the_nearest_wins_and_then_the_first(void **state) {
  (void)state;
  const char *const words[] = {"quad8", "quad4", "quad9"};
  assert_string_equal(cdem_suggest("quad4x", words, 3), "quad4");
  assert_string_equal(cdem_suggest("quad", words, 3), "quad8");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_change_is_near),
      cmocka_unit_test(other_words_are_not),
      cmocka_unit_test(the_nearest_wins_and_then_the_first),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
