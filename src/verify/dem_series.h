/* Private to verify: series of Chung & Ooi (2011, Granular Matter 13, 643), tests 4 to 6, as
 * digitised in the test data of Kratos; the same as data/reference/chung-ooi-*.csv, which says
 * more.
 */
#ifndef CDEM_VERIFY_DEM_SERIES_H
#define CDEM_VERIFY_DEM_SERIES_H

enum {
  CDEM_CHUNG_OOI_4 = 13,
  CDEM_CHUNG_OOI_5 = 14,
  CDEM_CHUNG_OOI_5_ELEMENTS = 10,
  CDEM_CHUNG_OOI_6 = 17,
  CDEM_CHUNG_OOI_6_RECOIL = 11
};
/* Aluminium oxide: incidence, degrees; tangential restitution; spin, rad/s; rebound of the contact
 * point, degrees. */
extern const double cdem_chung_ooi_4[CDEM_CHUNG_OOI_4][4];
/* Steel: incidence over mu v_n; rebound of the contact point over mu v_n'; spin over mu v_n/r. */
extern const double cdem_chung_ooi_5[CDEM_CHUNG_OOI_5][3];
/* Incidence and rebound by finite elements (Wu, Thornton & Li 2003). */
extern const double cdem_chung_ooi_5_elements[CDEM_CHUNG_OOI_5_ELEMENTS][2];
/* Aluminium alloy: x = 7/2 mu (1 + e) v_n/v_s; beta = -(sliding after)/(before). */
extern const double cdem_chung_ooi_6[CDEM_CHUNG_OOI_6][2];
/* Tangents of the angles of incidence and recoil of the contact point. */
extern const double cdem_chung_ooi_6_recoil[CDEM_CHUNG_OOI_6_RECOIL][2];

#endif
