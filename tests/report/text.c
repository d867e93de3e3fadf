/* What is put into a page: escaping, links, base64 and labels against their specifications. */
#include "report/text.h"

#include "report/number.h"
#include "support/test.h"

typedef void put(cdem_report_text *to, const char *text);

static void check_put(put *function, const char *text, const char *expected) {
  cdem_fault fault = {0};
  cdem_report_text to = {.fault = &fault};
  cdem_report_raw(&to, "");
  function(&to, text);
  check_ok(to.status);
  assert_string_equal(to.text, expected);
  cdem_report_text_release(&to);
}

static void markup_of_others_is_none_of_ours(void **state) {
  (void)state;
  check_put(cdem_report_escaped, "<b>&\"'", "&lt;b&gt;&amp;&quot;&#39;");
  check_put(cdem_report_escaped, "", "");
  check_put(cdem_report_escaped, "µ – 試験 🙂", "µ – 試験 🙂");
  check_put(cdem_report_escaped, "a\x01\x7f\x1b[1m\tb\nc", "a   [1m\tb\nc");
  check_put(cdem_report_words, "load_<x>", "load &lt;x&gt;");
  check_put(cdem_report_prose, "see `cdem <x>` or ` alone",
            "see <code>cdem &lt;x&gt;</code> or ` alone");
}

/* RFC 3629: what is no UTF-8 must not come through, and what follows it must. */
static void broken_utf_8_is_replaced(void **state) {
  (void)state;
  check_put(cdem_report_escaped, "\xff<", "\xef\xbf\xbd&lt;");
  check_put(cdem_report_escaped, "\xc3", "\xef\xbf\xbd");
  check_put(cdem_report_escaped, "\xe2\x82<", "\xef\xbf\xbd\xef\xbf\xbd&lt;");
  check_put(cdem_report_escaped, "\xc0\xbc", "\xef\xbf\xbd\xef\xbf\xbd"); /* overlong < */
  check_put(cdem_report_escaped, "\xed\xa0\x80",
            "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"); /* surrogate */
  check_put(cdem_report_escaped, "\xf4\x90\x80\x80z",
            "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbdz"); /* beyond U+10FFFF */
}

/* RFC 3986, section 2.3 (unreserved characters) and 4.2 (a colon in a first segment). */
static void links_hold_what_a_path_may_hold(void **state) {
  (void)state;
  check_put(cdem_report_link, "../run/body.pvd", "../run/body.pvd");
  check_put(cdem_report_link, "a b#c?d%e\"<", "a%20b%23c%3Fd%25e%22%3C");
  check_put(cdem_report_link, "µ", "%C2%B5");
  check_put(cdem_report_link, "javascript:x", "./javascript%3Ax");
}

/* The test vectors of RFC 4648, section 10. */
static void base64_is_that_of_the_standard(void **state) {
  (void)state;
  static const char *const vector[][2] = {{"", ""},
                                          {"f", "Zg=="},
                                          {"fo", "Zm8="},
                                          {"foo", "Zm9v"},
                                          {"foob", "Zm9vYg=="},
                                          {"fooba", "Zm9vYmE="},
                                          {"foobar", "Zm9vYmFy"}};
  static const unsigned char high[] = {0xfb, 0xff, 0xfe, 0x00};
  cdem_fault fault = {0};
  for (size_t i = 0; i < sizeof vector / sizeof vector[0]; i++) {
    cdem_report_text to = {.fault = &fault};
    cdem_report_base64(&to, (const unsigned char *)vector[i][0], (int64_t)strlen(vector[i][0]));
    check_ok(to.status);
    assert_string_equal(to.text, vector[i][1]);
    cdem_report_text_release(&to);
  }
  cdem_report_text to = {.fault = &fault};
  cdem_report_base64(&to, high, 4);
  assert_string_equal(to.text, "+//+AA==");
  cdem_report_text_release(&to);
}

static void check_label(cdem_report_place place, const char *label, const char *expected) {
  cdem_report_text to = {0};
  cdem_report_label(&to, label, place);
  assert_string_equal(to.text, expected);
  cdem_report_text_release(&to);
}

static void labels_know_the_markup_of_figures(void **state) {
  (void)state;
  check_label(CDEM_REPORT_IN_HTML, "k_1, m^2, s_{<a}\\_b",
              "k<sub>1</sub>, m<sup>2</sup>, s<sub>&lt;a</sub>_b");
  check_label(CDEM_REPORT_IN_WORDS, "k_1, m^2\\^", "k1, m2^");
  check_label(CDEM_REPORT_IN_HTML, "k_", "k<sub></sub>");
  check_label(CDEM_REPORT_IN_HTML, "k_{1", "k<sub>1</sub>");
  check_label(CDEM_REPORT_IN_SVG, "m^2/s",
              "m<tspan font-size=\"75%\" dy=\"-5\">2</tspan><tspan dy=\"5\">&#8203;</tspan>/s");
}

/* What sh makes of it, behind the escaping for HTML. */
static void arguments_come_back_from_sh(void **state) {
  (void)state;
  check_put(cdem_report_argument, "runs/a-1.yaml", "runs/a-1.yaml");
  check_put(cdem_report_argument, "a b", "&#39;a b&#39;");
  check_put(cdem_report_argument, "", "&#39;&#39;");
  check_put(cdem_report_argument, "it's $x", "&#39;it&#39;\\&#39;&#39;s $x&#39;");
}

static void no_allocation_is_taken_for_granted(void **state) {
  (void)state;
  cdem_status status = CDEM_MEMORY;
  for (int64_t n = 0; status == CDEM_MEMORY; n++) {
    cdem_fault fault = {0};
    cdem_report_text to = {.fault = &fault};
    cdem_memory_fail_after(n);
    for (int i = 0; i < 100; i++)
      cdem_report_escaped(&to, "some <text>");
    cdem_report_base64(&to, (const unsigned char *)"abc", 3);
    cdem_memory_fail_after(-1);
    status = to.status;
    assert_int_equal(fault.status, status);
    cdem_report_text_release(&to);
  }
  assert_int_equal(status, CDEM_OK);
}

/* ---- numbers ---- */

static void numbers_and_units_are_those_of_print(void **state) {
  (void)state;
  char text[CDEM_REPORT_NUMBER];
  assert_string_equal(cdem_report_number(-2.24e-5, 3, text), "−2.24 × 10⁻⁵");
  assert_string_equal(cdem_report_number(-0.0, 3, text), "0");
  assert_string_equal(cdem_report_number((double)NAN, 3, text), "–");
  assert_string_equal(cdem_report_number(-(double)INFINITY, 3, text), "−∞");
  assert_string_equal(cdem_report_number(21555.0, 15, text), "21555");
  assert_string_equal(cdem_report_quantity(3e10, 6, "Pa", text), "30\u00a0GPa");
  assert_string_equal(cdem_report_quantity(2700, 6, "kg/m3", text), "2700\u00a0kg/m³");
  assert_string_equal(cdem_report_quantity(0.25, 6, "", text), "0.25");
  assert_string_equal(cdem_report_quantity(1e-30, 4, "J", text), "1 × 10⁻³⁰\u00a0J");
  assert_string_equal(cdem_report_unit("kg m-3", text), "kg m⁻³");
  assert_string_equal(cdem_report_unit("1/s", text), "1/s");
  assert_string_equal(cdem_report_unit("N.m", text), "N m");
  assert_string_equal(cdem_report_size(1, text), "1 byte");
  assert_string_equal(cdem_report_size(999, text), "999 bytes");
  assert_string_equal(cdem_report_size(1400000, text), "1.4 MB");
  assert_string_equal(cdem_report_date(0, text), "1970-01-01 00:00 UTC");
  assert_string_equal(cdem_report_date(951782400, text), "2000-02-29 00:00 UTC");
  assert_string_equal(cdem_report_duration(0.0105, text), "10.5\u00a0ms");
  assert_string_equal(cdem_report_duration(725.2, text), "12 min 5 s");
  assert_string_equal(cdem_report_duration(12000.0, text), "3 h 20 min");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(markup_of_others_is_none_of_ours),
      cmocka_unit_test(broken_utf_8_is_replaced),
      cmocka_unit_test(links_hold_what_a_path_may_hold),
      cmocka_unit_test(base64_is_that_of_the_standard),
      cmocka_unit_test(labels_know_the_markup_of_figures),
      cmocka_unit_test(arguments_come_back_from_sh),
      cmocka_unit_test(no_allocation_is_taken_for_granted),
      cmocka_unit_test(numbers_and_units_are_those_of_print),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
