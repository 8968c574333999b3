"""All pages of the gallery, in their order."""

from scenes.lab.gallery import contacts, extremes, joints, masks, motions, piles, sweeps

PAGES = (*sweeps.PAGES, *piles.PAGES, *contacts.PAGES, *joints.PAGES, *motions.PAGES, *masks.PAGES, *extremes.PAGES)
