// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   pqVoxplexLabelModel
 * @brief   the labels of an image and what to do with each, as the rows of a table
 *
 * There is a row for each label of setLabels() and for each label that settings() mentions, in increasing order. What
 * the user changes are ticks and sizes.
 */
#ifndef pqVoxplexLabelModel_h
#define pqVoxplexLabelModel_h

#include "vtkPVLabelInformation.h"

#include <QAbstractTableModel>
#include <QList>
#include <QVariant>

#include <vector>

class pqVoxplexLabelModel : public QAbstractTableModel
{
  Q_OBJECT

public:
  enum Columns
  {
    Tick,
    Number,
    Name,
    Colour,
    Voxels,
    Size,
    NumberOfColumns
  };
  enum Roles
  {
    SearchRole = Qt::UserRole, ///< number and name, of every column
    SortRole
  };

  explicit pqVoxplexLabelModel(QObject* parent = nullptr);
  ~pqVoxplexLabelModel() override = default;

  void setLabels(const vtkPVLabelInformation::LabelMap& labels);

  ///@{
  /**
   * Label, size (0: no bound) and 0 or 1 (whether it is meshed) of the labels that are not treated like all others, as in
   * the property LabelTable. If a label is given twice, the last one counts.
   */
  void setSettings(const QList<QVariant>& values);
  QList<QVariant> settings() const;
  ///@}

  ///@{
  /** Of the image. */
  int numberOfLabels() const { return static_cast<int>(this->Labels.size()); }
  int numberMeshed() const;
  ///@}

  /**
   * Gives some rows the same tick (Qt::CheckState) or size (a number as text; empty or 0: no bound).
   * @return false if this cannot be
   */
  bool setRows(const QList<int>& rows, int column, const QVariant& value);

  int rowCount(const QModelIndex& parent = QModelIndex()) const override;
  int columnCount(const QModelIndex& parent = QModelIndex()) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;

Q_SIGNALS:
  /** By setRows(). */
  void settingsChanged();

private:
  Q_DISABLE_COPY(pqVoxplexLabelModel)

  struct Setting
  {
    double Size = 0.0;
    bool IsMeshed = true;
  };
  struct Row
  {
    vtkTypeInt64 Value;
    vtkPVLabelInformation::LabelEntry Label;
    bool Occurs; ///< in setLabels()
    Setting Chosen;
  };

  QVariant text(const Row& row, int column) const;
  QVariant sortKey(const Row& row, int column) const;

  vtkPVLabelInformation::LabelMap Labels;
  std::vector<Row> Rows;
};

#endif
